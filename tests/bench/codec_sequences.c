/* The demo's scenes as they are and, for the last two, a small object before a picture that does not move: the object is
 * what the renderer drew nearer than nothing, so its depth says which pixels are the backdrop's. */
#include "codec_sequences.h"

#include <string.h>

#include "demo/demo_scenes.h"
#include "demo/meshes/teapot.h"
#include "scene.h"

enum { ARENA_BYTES = 96 * 1024, NO_DEPTH = 0xFFFF };

typedef struct kind {
    const char *name;
    const el_scene *scene;
    void (*paint_backdrop)(void); /* NULL: none */
} kind;

static _Alignas(8) uint8_t arena[ARENA_BYTES];
static uint16_t backdrop[CODEC_WIDTH * CODEC_HEIGHT];
static size_t painted = CODEC_SEQUENCES; /* the sequence whose backdrop is there */

static bool play(const el_scene *scene, uint32_t frame, const el_sink *sink)
{
    static el_renderer renderer;
    return el_init(&renderer, &(el_config){.width = CODEC_WIDTH,
                                           .height = CODEC_HEIGHT,
                                           .band_lines = CODEC_BAND_LINES,
                                           .background = scene->background,
                                           .uv_error_log2 = 3,
                                           .memory = arena,
                                           .memory_bytes = sizeof arena,
                                           .sinks = {sink}}) == EL_OK &&
           el_scene_play(scene, frame, &renderer) == EL_OK;
}

/* --- Scenes that the demo does not have --------------------------------------------------------------------------- */

static void teapot_camera(uint32_t frame, el_camera *camera)
{
    el_teapot_scene.place_camera(frame, camera);
}

static el_status draw_dithered(uint32_t frame, el_renderer *renderer)
{
    static const el_light light = {.direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 80, .diffuse = 190};
    static const el_material material = {
        .shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_DITHER, .colour = {226, 146, 74}, .light = &light};
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, frame * (0xFFFFFFFFU / 120 + 1U));
    return el_draw(renderer, &teapot, &pose, &material);
}

/* The solid from three times as far away. */
static void far_camera(uint32_t frame, el_camera *camera)
{
    el_solid_scene.place_camera(frame, camera);
    for (unsigned i = 0; i < 3; i++) {
        camera->position_q16[i] *= 3;
    }
}

static el_status draw_solid(uint32_t frame, el_renderer *renderer)
{
    return el_solid_scene.draw(frame, renderer);
}

static const el_scene dithered = {
    .name = "dithered", .background = 0x10A3, .place_camera = teapot_camera, .draw = draw_dithered};
static const el_scene small = {.name = "small", .place_camera = far_camera, .draw = draw_solid};

/* --- Backdrops ---------------------------------------------------------------------------------------------------- */

static void keep_rows(void *context, el_band *band, unsigned slot)
{
    (void)context;
    memcpy(backdrop + (size_t)band->y * CODEC_WIDTH, band->pixels,
           (size_t)band->lines * CODEC_WIDTH * sizeof backdrop[0]);
    el_band_release(band, slot);
}

static void ignore_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void ignore_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static void paint_room(void)
{
    static const el_sink keep = {.begin = ignore_begin, .rows = keep_rows, .end = ignore_end};
    (void)play(&el_room_scene, 30, &keep);
}

static void fill(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint16_t colour)
{
    for (uint32_t line = y; line < y + height; line++) {
        for (uint32_t column = x; column < x + width; column++) {
            backdrop[line * CODEC_WIDTH + column] = colour;
        }
    }
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525U + 1013904223U;
    return *state >> 16;
}

/* Words of made-up letters, 5 x 7 pixels each in a cell of 6 x 10. */
static void write_text(uint32_t x, uint32_t y, uint32_t letters, uint16_t colour, uint32_t *state)
{
    for (uint32_t i = 0; i < letters; i++) {
        const uint32_t letter = next_random(state) % 26;
        if (letter % 6 == 0) {
            continue; /* a space */
        }
        uint32_t strokes = letter * 2654435761U;
        for (uint32_t bit = 0; bit < 35; bit++) {
            if ((strokes >> bit % 29 & 1U) != 0) {
                backdrop[(y + bit / 5) * CODEC_WIDTH + x + i * 6 + bit % 5] = colour;
            }
        }
    }
}

/* A settings page: a title, a frame around the place of the object, rows of text with buttons. */
static void paint_page(void)
{
    enum { PAPER = 0xEF7D, TITLE = 0x2A6F, INK = 0x2104, LINE = 0x9CF3, BUTTON = 0xC638, ROWS = 9 };
    uint32_t state = 20261122;
    fill(0, 0, CODEC_WIDTH, CODEC_HEIGHT, PAPER);
    fill(0, 0, CODEC_WIDTH, 22, TITLE);
    write_text(8, 7, 18, 0xFFFF, &state);
    fill(112, 72, 96, 96, LINE);
    fill(113, 73, 94, 94, 0);
    for (uint32_t row = 0; row < ROWS; row++) {
        const uint32_t y = 32 + 22 * row;
        write_text(8, y, 15, INK, &state);
        fill(218, y - 5, 94, 17, LINE);
        fill(219, y - 4, 92, 15, BUTTON);
        write_text(226, y, 12, INK, &state);
    }
}

/* --- The sequences ------------------------------------------------------------------------------------------------ */

static const kind sequences[CODEC_SEQUENCES] = {
    {"flat", &el_solid_scene, NULL},     {"field", &el_field_scene, NULL}, {"gouraud", &el_teapot_scene, NULL},
    {"dithered", &dithered, NULL},       {"room", &el_room_scene, NULL},   {"page", &small, paint_page},
    {"static-room", &small, paint_room},
};

const char *codec_sequence_name(size_t sequence)
{
    return sequences[sequence].name;
}

static void compose_begin(void *context, uint16_t width, uint16_t height)
{
    const el_sink *const to = context;
    to->begin(to->context, width, height);
}

static void compose_rows(void *context, el_band *band, unsigned slot)
{
    const el_sink *const to = context;
    const uint16_t *const behind = backdrop + (size_t)band->y * CODEC_WIDTH;
    for (uint32_t i = 0; i < (uint32_t)band->lines * CODEC_WIDTH; i++) {
        band->pixels[i] = band->depth[i] == NO_DEPTH ? behind[i] : band->pixels[i];
    }
    to->rows(to->context, band, slot);
}

static void compose_end(void *context, const el_stats *stats)
{
    const el_sink *const to = context;
    to->end(to->context, stats);
}

bool codec_sequence_play(size_t sequence, uint32_t frame, const el_sink *sink)
{
    const kind *const shown = &sequences[sequence];
    if (shown->paint_backdrop == NULL) {
        return play(shown->scene, frame, sink);
    }
    if (painted != sequence) {
        shown->paint_backdrop();
        painted = sequence;
    }
    el_sink to = *sink;
    const el_sink compose = {.context = &to, .begin = compose_begin, .rows = compose_rows, .end = compose_end};
    return play(shown->scene, frame, &compose);
}
