/* The OLED of an SSD1306, mounted as EL_DEMO_ROTATION says. */
#include "demo/demo_panel.h"
#include "panel/ssd1306.h"

el_status el_demo_panel_start(const el_bus *bus, el_demo_panel *panel)
{
    static uint8_t memory[EL_SSD1306_MEMORY_BYTES(EL_DEMO_BAND_LINES)];
    static el_ssd1306 oled;
    const el_ssd1306_config config = {
        .bus = bus, .rotation = EL_DEMO_ROTATION, .memory = memory, .memory_bytes = sizeof memory};
    const el_status status = el_ssd1306_init(&oled, &config);
    if (status == EL_OK) {
        *panel = (el_demo_panel){
            .sink = el_ssd1306_sink(&oled), .width = el_oled_width(&oled), .height = el_oled_height(&oled)};
    }
    return status;
}
