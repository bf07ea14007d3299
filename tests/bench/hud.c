/* A HUD of all that canvas/ draws: paint/'s page of glass, text and polygons, and sprites beside it. */
#include "own_scenes.h"
#include "paint/pages.h"

enum { SIDE = 16 };

/* A ring around a dot. */
static const uint8_t ring[SIDE * SIDE / 8] = {0x07, 0xE0, 0x18, 0x18, 0x20, 0x04, 0x40, 0x02, 0x40, 0x02, 0x83,
                                              0xC1, 0x87, 0xE1, 0x87, 0xE1, 0x87, 0xE1, 0x87, 0xE1, 0x83, 0xC1,
                                              0x40, 0x02, 0x40, 0x02, 0x20, 0x04, 0x18, 0x18, 0x07, 0xE0};
static const uint16_t ink[1] = {0xFFE0};
static const el_image sprite = {.width = SIDE, .height = SIDE, .format = EL_IMAGE_MASK, .pixels = ring, .palette = ink};

static void draw(void *context, el_band *band)
{
    static const el_image_place turned = {.x = EL_SUB(260),
                                          .y = EL_SUB(40),
                                          .angle = EL_DEGREES(30, 1),
                                          .scale_q16 = 3 * 65536,
                                          .smooth = true,
                                          .alpha = 200};
    const el_canvas canvas = el_canvas_of(band);
    (void)context;
    for (int32_t i = 0; i < 5; i++) {
        el_canvas_image(&canvas, &sprite, 200 + 20 * i, 80, 255);
    }
    (void)el_canvas_image_turned(&canvas, &sprite, &turned);
    el_page_draw(&(el_page_frame){.page = el_page_find("hud"), .frame = 0}, band);
}

const el_layer bench_hud = {.draw = draw};
