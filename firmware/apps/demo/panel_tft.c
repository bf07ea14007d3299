/* A colour panel; EL_DEMO_MODEL is its model and EL_DEMO_ROTATION how it is mounted. */
#include "demo/demo_panel.h"
#include "panel/ili9341.h"
#include "panel/st7735.h"
#include "panel/st7789.h"
#include "panel/tft.h"

el_status el_demo_panel_start(const el_bus *bus, el_demo_panel *panel)
{
    static el_tft tft;
    el_tft_config config = {.bus = bus, .model = &EL_DEMO_MODEL, .rotation = EL_DEMO_ROTATION};
#if EL_DEMO_SPARING && EL_WITH_REUSE
    static uint32_t shown[EL_TFT_SHOWN_BYTES(240, 320) / sizeof(uint32_t)]; /* the largest, upright; lying it is less */
    config.shown = shown;
    config.shown_bytes = sizeof shown;
#endif
    const el_status status = el_tft_init(&tft, &config);
    if (status == EL_OK) {
        *panel = (el_demo_panel){.sink = el_tft_sink(&tft), .width = el_tft_width(&tft), .height = el_tft_height(&tft)};
    }
    return status;
}
