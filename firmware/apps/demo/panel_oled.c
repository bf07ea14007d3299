/* An OLED; EL_DEMO_INIT, EL_DEMO_SINK and EL_DEMO_PANEL_MEMORY are its controller's, EL_DEMO_ROTATION how it is
 * mounted. */
#include "demo/demo_panel.h"
#include "panel/oled.h"
#include "panel/ssd0323.h"
#include "panel/ssd1306.h"

el_status el_demo_panel_start(const el_bus *bus, el_demo_panel *panel)
{
    static uint8_t memory[EL_DEMO_PANEL_MEMORY(EL_DEMO_BAND_LINES)];
    static el_oled oled;
    const el_oled_config config = {
        .bus = bus, .rotation = EL_DEMO_ROTATION, .memory = memory, .memory_bytes = sizeof memory};
    const el_status status = EL_DEMO_INIT(&oled, &config);
    if (status == EL_OK) {
        *panel = (el_demo_panel){
            .sink = EL_DEMO_SINK(&oled), .width = el_oled_width(&oled), .height = el_oled_height(&oled)};
    }
    return status;
}
