/* The public interface on any scene. Whatever is drawn must be the same in other bands and another arena, and so must each
 * call's answer. */
#include "any_scene.h"

typedef struct answers {
    int init, begin, draws[MAX_DRAWS];
} answers;

/* Draws the scene; the arena has the bytes that it says, so that AddressSanitizer sees its end, and begins anywhere. */
static answers draw(const scene *s, way how, unsigned misalignment, picture *p)
{
    p->width = s->width;
    p->height = s->height;
    const el_sink sink = picture_sink(p);
    how.memory_bytes += EL_SAMPLES_BYTES((unsigned)s->width, (unsigned)how.band_lines, s->samples);
    uint8_t *const memory = malloc(how.memory_bytes + misalignment);
    FUZZ_EXPECT(memory != NULL);
    const el_config config = {
        .width = s->width,
        .height = s->height,
        .band_lines = how.band_lines,
        .background = s->background,
        .uv_error_log2 = s->uv_error_log2,
        .samples = s->samples,
        .memory = memory + misalignment,
        .memory_bytes = how.memory_bytes,
        .sinks = {NULL, &sink},
    };
    el_renderer renderer;
    answers a = {.init = el_init(&renderer, &config)};
    a.begin = a.init == EL_OK ? (int)el_frame_begin(&renderer, &s->camera) : a.init;
    for (int more = a.begin == EL_OK; more > 0; more = el_frame_next(&renderer)) {
        for (unsigned i = 0; i < s->count; i++) {
            const item *const t = &s->items[i];
            a.draws[i] = el_draw(&renderer, &t->mesh, &t->pose, &t->material);
        }
    }
    free(memory);
    return a;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    static scene s;
    static picture first;
    static picture second;
    input in = {bytes, count};
    memset(&s, 0, sizeof s);
    const uint8_t lines[2] = {take_u8(&in), take_u8(&in)};
    const uint16_t more[2] = {take_u16(&in), take_u16(&in)};
    const uint8_t misalignment = take_u8(&in) % 8;
    take_scene(&in, &s);
    const answers a = draw(&s, way_of(s.width, s.height, lines[0], more[0]), 0, &first);
    const answers b = draw(&s, way_of(s.width, s.height, lines[1], more[1]), misalignment, &second);
    FUZZ_EXPECT(memcmp(&a, &b, sizeof a) == 0);
    if (a.begin == EL_OK) {
        expect_same_pictures(&first, &second);
    }
    return 0;
}
