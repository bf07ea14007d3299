/* canvas/ on any calls, all kinds mixed. Whatever is drawn stays within the band, which AddressSanitizer watches, and is the
 * same in bands of any two heights; and each call's answer is the same in every band, but for the memory of smooth
 * polygons, of which a band without them needs none. */
#include "any_call.h"

enum { MAX_CALLS = 12 };

typedef struct program {
    uint16_t width, height;
    unsigned count;
    call calls[MAX_CALLS];
} program;

/* Each band has memory of its own, so that AddressSanitizer sees its ends. */
static void draw(const program *p, uint16_t lines, uint16_t *picture)
{
    for (uint16_t y = 0; y < p->height; y = (uint16_t)(y + lines)) {
        const uint16_t there = (uint16_t)(p->height - y < lines ? p->height - y : lines);
        const size_t bytes = (size_t)there * p->width * sizeof picture[0];
        el_band band = {.pixels = malloc(bytes), .width = p->width, .y = y, .lines = there};
        FUZZ_EXPECT(band.pixels != NULL);
        memset(band.pixels, 0x21, bytes);
        const el_canvas canvas = el_canvas_of(&band);
        for (unsigned i = 0; i < p->count; i++) {
            draw_call(&p->calls[i], &canvas);
        }
        memcpy(picture + (size_t)y * p->width, band.pixels, bytes);
        free(band.pixels);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    static program p;
    static uint16_t pictures[2][CALL_SIDE * CALL_SIDE];
    input in = {bytes, count};
    memset(&p, 0, sizeof p);
    p.width = (uint16_t)(1 + take_u8(&in) % CALL_SIDE);
    p.height = (uint16_t)(1 + take_u8(&in) % CALL_SIDE);
    const uint16_t lines[2] = {(uint16_t)(1 + take_u8(&in) % CALL_SIDE), (uint16_t)(1 + take_u8(&in) % CALL_SIDE)};
    p.count = 1U + take_u8(&in) % MAX_CALLS;
    for (unsigned i = 0; i < p.count; i++) {
        take_call(&in, &p.calls[i]);
    }
    for (unsigned i = 0; i < 2; i++) {
        draw(&p, lines[i], pictures[i]);
    }
    FUZZ_EXPECT(memcmp(pictures[0], pictures[1], sizeof pictures[0][0] * p.width * p.height) == 0);
    return 0;
}
