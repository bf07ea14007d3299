/* All of the library in one show: any scene, whose items are lit by lamps, hang on each other, move by keys, face the camera
 * and are drawn as instances of two levels; any calls of canvas/ under and over it; and a camera that somebody turns from
 * frame to frame. Each frame is the same picture whatever bands, arena and cores there are, with a depth pre-pass, where the
 * frame before is used again, and, of every other line, interlaced; each call's answer is the same, and what is picked is
 * what is seen.
 *
 * An input begins as fuzz_renderer's does: the two share what finds their way into the renderer. */
#include "any_call.h"
#include "any_scene.h"
#include "threads.h"

enum { MAX_FRAMES = 3, LAYER_CALLS = 3, KEYS = 3, LAMPS = 3, MAX_CORES = 3, LEVELS = 2, WAYS = 3 };

/* Bits of part.kind. */
enum {
    BY_INSTANCE = 1,
    LIT_VERTICES = 2,
    LIT_TRIANGLES = 4,
    FADES = 8,
    HANGS = 16,
    MOVES = 32,
    FACES = 64,
    UPRIGHT = 128
};

typedef struct layer {
    unsigned count;
    bool is_steady; /* all calls in each frame, or one by one */
    call calls[LAYER_CALLS];
} layer;

/* What an item of the scene does beside being there. */
typedef struct part {
    uint8_t kind;
    uint32_t at_ms[KEYS];
    int32_t positions_q16[KEYS][3];
    el_quaternion rotations[KEYS];
    uint32_t scales_q16[KEYS];
    el_animation animation;
    el_lamp lamps[LAMPS];
    el_highlight highlight;
    el_lighting lighting;
    uint16_t least_px;
} part;

typedef struct show {
    scene scene;
    part parts[MAX_DRAWS];
    layer under, over;
    unsigned frames;
    el_orbit orbits[MAX_FRAMES];
    uint32_t times_ms[MAX_FRAMES];
    uint16_t x, y; /* of the pixel that is picked */
    uint8_t stripes;
    uint16_t memory_width; /* with those */
} show;

/* How it is drawn: must not show. */
typedef struct manner {
    way way;
    unsigned misalignment;
    unsigned cores;
    bool depth_prepass;
    bool interlaced; /* each frame has every other line alone */
    uint8_t reuse;
} manner;

/* --- Out of the fuzzer's bytes ---------------------------------------------------------------------------------------- */

static void take_layer(input *in, layer *l)
{
    const uint8_t kind = take_u8(in);
    l->count = kind % (LAYER_CALLS + 1);
    l->is_steady = (kind & 128) != 0;
    for (unsigned i = 0; i < l->count; i++) {
        take_call(in, &l->calls[i]);
    }
}

static el_key_times take_times(input *in, const part *p)
{
    return (el_key_times){.at_ms = p->at_ms, .count = take_u8(in) % (KEYS + 1), .between = take_u8(in) % 3};
}

static void take_motion(input *in, part *p)
{
    for (unsigned i = 0; i < KEYS; i++) {
        p->at_ms[i] = (i > 0 ? p->at_ms[i - 1] + 1 : 0) + take_u16(in);
        take_bytes(in, p->positions_q16[i], sizeof p->positions_q16[i]);
        take_bytes(in, &p->rotations[i], sizeof p->rotations[i]);
        p->rotations[i] = el_quaternion_normalise(&p->rotations[i]);
        p->scales_q16[i] = 1 + take_u32(in) / 2;
    }
    p->animation = (el_animation){.position = {.keys = take_times(in, p), .values_q16 = p->positions_q16},
                                  .rotation = {.keys = take_times(in, p), .values = p->rotations},
                                  .scale = {.keys = take_times(in, p), .values_q16 = p->scales_q16},
                                  .length_ms = take_u16(in),
                                  .repeat = take_u8(in) % 3};
}

static void take_lamps(input *in, part *p)
{
    p->lighting = (el_lighting){.lamps = p->lamps, .lamp_count = take_u8(in) % (LAMPS + 1)};
    const uint8_t sharpness = take_u8(in);
    if (sharpness != 0) { /* of any exponent, and of none */
        (void)el_highlight_make(&p->highlight, 5U * (sharpness - 1U));
        p->lighting.highlight = &p->highlight;
    }
    take_bytes(in, p->lighting.ambient, sizeof p->lighting.ambient);
    take_bytes(in, p->lighting.emissive, sizeof p->lighting.emissive);
    take_bytes(in, p->lighting.specular, sizeof p->lighting.specular);
    p->lighting.two_sided = take_u8(in) % 2 == 1;
    for (unsigned i = 0; i < p->lighting.lamp_count; i++) {
        el_lamp *const lamp = &p->lamps[i];
        lamp->kind = take_u8(in) % (EL_LAMP_SPOT + 2);
        take_bytes(in, lamp->colour, sizeof lamp->colour);
        take_bytes(in, lamp->direction_q30, sizeof lamp->direction_q30);
        take_bytes(in, lamp->position_q16, sizeof lamp->position_q16);
        lamp->half_q16 = take_u32(in);
        lamp->inner_q30 = take_i32(in);
        lamp->outer_q30 = take_i32(in);
    }
}

static void take_show(input *in, show *s)
{
    take_scene(in, &s->scene);
    for (unsigned i = 0; i < s->scene.count; i++) {
        part *const p = &s->parts[i];
        p->kind = take_u8(in);
        p->least_px = (uint16_t)(take_u8(in) * 257);
        if ((p->kind & MOVES) != 0) {
            take_motion(in, p);
        }
        if ((p->kind & (LIT_VERTICES | LIT_TRIANGLES)) != 0) {
            take_lamps(in, p);
        }
    }
    take_layer(in, &s->under);
    take_layer(in, &s->over);
    s->frames = 1U + take_u8(in) % MAX_FRAMES;
    for (unsigned i = 0; i < s->frames; i++) {
        const uint8_t kind = take_u8(in);
        s->times_ms[i] = (kind & 1) != 0 ? take_u32(in) : 0;
        if ((kind & 2) != 0) {
            s->orbits[i] = (el_orbit){
                .yaw = take_u16(in),
                .pitch = (int16_t)(take_u16(in) % (2 * EL_ORBIT_QUARTER_TURN + 1) - EL_ORBIT_QUARTER_TURN),
                .zoom_q8 = (int16_t)(take_u16(in) % (2 * EL_ORBIT_MAX_ZOOM_Q8 + 1) - EL_ORBIT_MAX_ZOOM_Q8),
                .pan_q8 = {(int16_t)(take_u16(in) % (2 * EL_ORBIT_MAX_PAN_Q8 + 1) - EL_ORBIT_MAX_PAN_Q8),
                           (int16_t)(take_u16(in) % (2 * EL_ORBIT_MAX_PAN_Q8 + 1) - EL_ORBIT_MAX_PAN_Q8)},
            };
        }
    }
    s->x = (uint16_t)(take_u8(in) % s->scene.width);
    s->y = (uint16_t)(take_u8(in) % s->scene.height);
}

/* --- A frame ------------------------------------------------------------------------------------------------------------ */

/* All that the renderer is shown, made anew for each frame. */
typedef struct moment {
    const show *show;
    unsigned frame;
    el_camera camera;
    el_pose poses[MAX_DRAWS];
    el_material materials[MAX_DRAWS];
    el_mesh meshes[MAX_DRAWS][LEVELS]; /* the second one has half of the triangles */
    el_level levels[MAX_DRAWS][LEVELS];
    el_instance instances[MAX_DRAWS]; /* keeps its level from frame to frame */
    uint8_t lit[MAX_DRAWS][MAX_TRIANGLES][3];
} moment;
_Static_assert(MAX_TRIANGLES >= MAX_VERTICES, "there is room for either's colours");

static void place_items(moment *m)
{
    static const int32_t up[3] = {0, 1, 0};
    const scene *const s = &m->show->scene;
    el_node nodes[MAX_DRAWS];
    for (unsigned i = 0; i < s->count; i++) {
        const part *const p = &m->show->parts[i];
        nodes[i] = (el_node){.parent = (int16_t)((p->kind & HANGS) != 0 ? (int)i - 1 : EL_NO_PARENT),
                             .local = s->items[i].pose};
        if ((p->kind & MOVES) != 0) {
            el_animation_pose(&p->animation, m->show->times_ms[m->frame], &nodes[i].local);
        }
    }
    FUZZ_EXPECT(el_hierarchy_update(nodes, m->poses, (uint16_t)s->count) == EL_OK);
    for (unsigned i = 0; i < s->count; i++) {
        switch (m->show->parts[i].kind & (FACES | UPRIGHT)) {
        case FACES:
            el_billboard_face(&m->poses[i], &m->camera);
            break;
        case UPRIGHT:
            (void)el_billboard_about(&m->poses[i], &m->camera, up);
            break;
        case FACES | UPRIGHT:
            (void)el_pose_look_at(&m->poses[i], m->camera.position_q16, up);
            break;
        default:
            break;
        }
    }
}

/* A mesh in the light of its lamps, if they can be used; el_draw looks at what el_light_vertices does not. */
static void light_item(moment *m, unsigned at)
{
    const part *const p = &m->show->parts[at];
    const item *const t = &m->show->scene.items[at];
    const int32_t *const eye_q16 = m->camera.position_q16;
    el_mesh *const mesh = &m->meshes[at][0];
    if ((p->kind & LIT_VERTICES) != 0 &&
        el_light_vertices(&p->lighting, &t->mesh, &m->poses[at], eye_q16, m->lit[at]) == EL_OK) {
        mesh->colours = (const uint8_t(*)[3])m->lit[at];
    } else if ((p->kind & LIT_TRIANGLES) != 0 &&
               el_light_triangles(&p->lighting, &t->mesh, &m->poses[at], eye_q16, m->lit[at]) == EL_OK) {
        mesh->triangle_colours = (const uint8_t(*)[3])m->lit[at];
    }
}

/* True: what pointers name has changed. */
static bool make_moment(moment *m)
{
    const scene *const s = &m->show->scene;
    static uint8_t before[sizeof m->lit];
    memcpy(before, m->lit, sizeof before);
    m->camera = s->camera;
    el_orbit_apply(&m->show->orbits[m->frame], el_orbit_focus_q16(&s->camera), &m->camera);
    place_items(m);
    for (unsigned i = 0; i < s->count; i++) {
        const part *const p = &m->show->parts[i];
        m->materials[i] = s->items[i].material;
        if (EL_WITH_MIXED && (p->kind & FADES) != 0) {
            m->materials[i].alpha = (uint8_t)(m->materials[i].alpha + 37 * m->frame);
        }
        m->meshes[i][0] = s->items[i].mesh;
        light_item(m, i);
        m->meshes[i][1] = m->meshes[i][0];
        m->meshes[i][1].triangle_count /= 2;
        for (unsigned k = 0; k < LEVELS; k++) {
            m->levels[i][k] = (el_level){.mesh = &m->meshes[i][k], .least_px = p->least_px};
        }
        m->instances[i] = (el_instance){.levels = m->levels[i],
                                        .pose = &m->poses[i],
                                        .material = &m->materials[i],
                                        .level_count = LEVELS,
                                        .level = m->instances[i].level};
    }
    return memcmp(before, m->lit, sizeof before) != 0;
}

/* --- Layers and sinks ----------------------------------------------------------------------------------------------------- */

typedef struct painted {
    const layer *layer;
    const moment *moment;
} painted;

static void paint(void *context, el_band *band)
{
    const painted *const p = context;
    const el_canvas canvas = el_canvas_of(band);
    for (unsigned i = 0; i < p->layer->count; i++) {
        if (p->layer->is_steady || i == p->moment->frame % p->layer->count) {
            draw_call(&p->layer->calls[i], &canvas);
        }
    }
}

static bool is_as_it_was(void *context, uint16_t y, uint16_t lines)
{
    const painted *const p = context;
    (void)y;
    (void)lines;
    return p->layer->is_steady || p->layer->count < 2;
}

/* A sink that keeps its picture does without what it has. */
typedef struct keeper {
    picture picture;
    bool has_frame;
    bool is_fresh[PICTURE_SIDE]; /* of each line, whether this frame has it */
} keeper;

static void keep_begin(void *context, uint16_t width, uint16_t height)
{
    keeper *const k = context;
    FUZZ_EXPECT(width == k->picture.width && height == k->picture.height);
    memset(k->is_fresh, 0, sizeof k->is_fresh);
}

static void keep_rows(void *context, el_band *band, unsigned slot)
{
    keeper *const k = context;
    const size_t bytes = band->width * sizeof band->pixels[0];
    FUZZ_EXPECT(band->width == k->picture.width && band->lines > 0);
    for (unsigned i = 0; i < band->lines; i++) {
        const unsigned y = band->y + i * (1U + band->gap);
        FUZZ_EXPECT(y < k->picture.height && !k->is_fresh[y]);
        k->is_fresh[y] = true;
        memcpy(k->picture.colour + y * band->width, band->pixels + i * band->width, bytes);
        memcpy(k->picture.depth + y * band->width, band->depth + i * band->width, bytes);
    }
    el_band_release(band, slot);
}

static bool keep_unchanged(void *context, uint16_t y, uint16_t lines)
{
    const keeper *const k = context;
    FUZZ_EXPECT(lines > 0 && y + lines <= k->picture.height);
    return k->has_frame;
}

static void keep_end(void *context, const el_stats *stats)
{
    keeper *const k = context;
    (void)stats;
    k->has_frame = true;
}

/* --- Drawing ---------------------------------------------------------------------------------------------------------------- */

typedef struct outcome {
    int init;
    int begin[MAX_FRAMES];
    int draws[MAX_FRAMES][MAX_DRAWS];
    picture pictures[MAX_FRAMES];
    bool is_fresh[MAX_FRAMES][PICTURE_SIDE];
} outcome;

static const el_workers *cores(unsigned count)
{
    static el_threads *threads[MAX_CORES + 1]; /* for all inputs: threads are dear */
    if (threads[count] == NULL) {
        threads[count] = el_threads_open(count);
        FUZZ_EXPECT(threads[count] != NULL);
    }
    return el_threads_workers(threads[count]);
}

static void draw_frame(el_renderer *renderer, moment *m, outcome *o)
{
    int *const draws = o->draws[m->frame];
    int more;
    do {
        for (unsigned i = 0; i < m->show->scene.count; i++) {
            draws[i] = (m->show->parts[i].kind & BY_INSTANCE) != 0
                           ? el_instances_draw(renderer, &m->instances[i], 1)
                           : el_draw(renderer, &m->meshes[i][0], &m->poses[i], &m->materials[i]);
        }
        more = el_frame_next(renderer);
        FUZZ_EXPECT(more >= 0);
    } while (more > 0);
}

/* Draws all frames. The arena has the bytes that it says, so that AddressSanitizer sees its end, and begins anywhere. */
static void play(moment *m, const manner *how, outcome *o)
{
    static keeper k;
    const scene *const s = &m->show->scene;
    memset(&k, 0, sizeof k);
    k.picture.width = s->width;
    k.picture.height = s->height;
    el_sink sink = {.context = &k,
                    .begin = keep_begin,
                    .rows = keep_rows,
                    .unchanged = keep_unchanged,
                    .end = keep_end,
                    .takes_gaps = true};
    painted painted_under = {&m->show->under, m};
    painted painted_over = {&m->show->over, m};
    const el_layer under = {.context = &painted_under, .draw = paint, .unchanged = is_as_it_was};
    const el_layer over = {.context = &painted_over, .draw = paint, .unchanged = is_as_it_was};
    const unsigned lines = how->way.band_lines;
    const unsigned width = m->show->memory_width;
    const size_t bytes = how->way.memory_bytes + how->cores * EL_SAMPLES_BYTES(width, lines, s->samples) +
                         EL_WORKERS_BYTES(width, (unsigned)s->height, lines, how->cores);
    uint8_t *const memory = malloc(bytes + how->misalignment);
    FUZZ_EXPECT(memory != NULL);
    const el_config config = {
        .width = s->width,
        .height = s->height,
        .band_lines = how->way.band_lines,
        .background = s->background,
        .uv_error_log2 = s->uv_error_log2,
        .reuse = how->reuse,
        .interlaced = how->interlaced,
        .samples = s->samples,
        .stripes = m->show->stripes,
        .depth_prepass = how->depth_prepass,
        .memory = memory + how->misalignment,
        .memory_bytes = bytes,
        .sinks = {NULL, &sink},
        .under = &under,
        .over = &over,
        .workers = how->cores > 1 ? cores(how->cores) : NULL,
    };
    el_renderer renderer;
    memset(m->instances, 0, sizeof m->instances);
    memset(m->lit, 0, sizeof m->lit);
    o->init = el_init(&renderer, &config);
    for (m->frame = 0; m->frame < m->show->frames && o->init == EL_OK; m->frame++) {
        if (make_moment(m)) {
            el_frame_forget(&renderer);
        }
        o->begin[m->frame] = el_frame_begin(&renderer, &m->camera);
        if (o->begin[m->frame] == EL_OK) {
            draw_frame(&renderer, m, o);
            o->pictures[m->frame] = k.picture;
            memcpy(o->is_fresh[m->frame], k.is_fresh, sizeof k.is_fresh);
        }
    }
    free(memory);
}

/* --- What must hold ------------------------------------------------------------------------------------------------------- */

/* All calls have the same answers; of each frame the picture is the same, of an interlaced one every other line. */
static void expect_same(const show *s, const outcome *whole, const outcome *other, bool interlaced)
{
    FUZZ_EXPECT(whole->init == other->init);
    FUZZ_EXPECT(memcmp(whole->begin, other->begin, sizeof whole->begin) == 0);
    FUZZ_EXPECT(memcmp(whole->draws, other->draws, sizeof whole->draws) == 0);
    for (unsigned frame = 0; frame < s->frames; frame++) {
        if (!interlaced) {
            expect_same_pictures(&whole->pictures[frame], &other->pictures[frame]);
            continue;
        }
        const bool *const is_fresh = other->is_fresh[frame];
        for (unsigned y = 0; y < s->scene.height && whole->init == EL_OK && whole->begin[frame] == EL_OK; y++) {
            const size_t at = (size_t)y * s->scene.width;
            const size_t bytes = s->scene.width * sizeof whole->pictures[0].colour[0];
            FUZZ_EXPECT(y == 0 || is_fresh[y] != is_fresh[y - 1]);
            FUZZ_EXPECT(!is_fresh[y] ||
                        (memcmp(whole->pictures[frame].colour + at, other->pictures[frame].colour + at, bytes) == 0 &&
                         memcmp(whole->pictures[frame].depth + at, other->pictures[frame].depth + at, bytes) == 0));
        }
    }
}

/* Neither what is seen through nor what counts pixels, nor wires, whose triangles are picked: the pixel's depth is that of
 * what is picked. */
static bool is_plain(const el_material *material)
{
    return (material->flags & (EL_MATERIAL_NO_DEPTH | EL_MATERIAL_WIRES)) == 0 &&
           material->shading < EL_SHADE_OVERDRAW && (!EL_WITH_MIXED || (uint8_t)(material->alpha + 1U) <= 1U) &&
           (material->texture == NULL || material->texture->image == NULL);
}

static int pick(const moment *m, size_t more, const int answers[], el_picked *picked)
{
    const scene *const s = &m->show->scene;
    const size_t bytes = EL_PICK_BYTES((size_t)s->width, (size_t)s->height) + more;
    void *const memory = malloc(bytes);
    FUZZ_EXPECT(memory != NULL);
    el_pick p;
    FUZZ_EXPECT(el_pick_begin(&p, &m->camera, s->width, s->height, m->show->x, m->show->y, memory, bytes) == EL_OK);
    for (unsigned i = 0; i < s->count; i++) {
        const int status = (m->show->parts[i].kind & BY_INSTANCE) != 0
                               ? el_instances_pick(&p, &m->instances[i], 1)
                               : el_pick_draw(&p, &m->meshes[i][0], &m->poses[i], &m->materials[i]);
        /* Samples and stripes refuse what picking does without them. */
        FUZZ_EXPECT(s->samples != 0 || m->show->stripes != EL_STRIPES_NONE || status == answers[i]);
    }
    const int is_found = el_pick_end(&p, picked);
    free(memory);
    return is_found;
}

/* In the last frame, of which the moment is. */
static void expect_picked(const moment *m, const outcome *o)
{
    const scene *const s = &m->show->scene;
    const unsigned last = m->show->frames - 1;
    el_picked a = {0};
    el_picked b = {0};
    const int is_found = pick(m, 0, o->draws[last], &a);
    FUZZ_EXPECT(pick(m, 3000, o->draws[last], &b) == is_found);
    FUZZ_EXPECT(a.draw == b.draw && a.triangle == b.triangle && a.depth == b.depth);
    FUZZ_EXPECT(a.draw < s->count && a.triangle < MAX_TRIANGLES);
    bool is_seen = s->samples == 0 && m->show->stripes == EL_STRIPES_NONE;
    for (unsigned i = 0; i < s->count; i++) {
        is_seen = is_seen && is_plain(&m->materials[i]);
    }
    if (is_seen) {
        const uint16_t depth = o->pictures[last].depth[m->show->y * s->width + m->show->x];
        FUZZ_EXPECT(is_found == (depth != UINT16_MAX) && (is_found == 0 || a.depth == depth));
    }
}

/* The pre-pass refuses samples and blended depth, and pixels that count what is drawn are not the same with it. */
static bool can_draw_depth_first(const show *s)
{
    for (unsigned i = 0; i < s->scene.count; i++) {
        const el_material *const material = &s->scene.items[i].material;
        if ((material->flags & EL_MATERIAL_BLEND_DEPTH) != 0 || material->shading >= EL_SHADE_OVERDRAW) {
            return false;
        }
    }
    return EL_WITH_PREPASS && s->scene.samples == 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    static show s;
    static moment m;
    static outcome outcomes[WAYS];
    input in = {bytes, count};
    memset(&s, 0, sizeof s);
    memset(&m, 0, sizeof m);
    memset(outcomes, 0, sizeof outcomes);
    const uint8_t lines[2] = {take_u8(&in), take_u8(&in)};
    const uint16_t more[2] = {take_u16(&in), take_u16(&in)};
    const uint8_t misalignment = take_u8(&in);
    take_show(&in, &s);
    const uint8_t choices = take_u8(&in);
    s.stripes = (choices >> 5) % (EL_WITH_STRIPES ? EL_STRIPES_COUNT : 1);
    s.memory_width = (uint16_t)(s.stripes == EL_STRIPES_NONE ? s.scene.width : EL_STRIPED_WIDTH(s.scene.width));
    manner manners[WAYS] = {
        {.way = way_of(s.memory_width, s.scene.height, lines[1], more[1]), .misalignment = misalignment % 8},
        {.way = way_of(s.memory_width, s.scene.height, lines[0], more[0])},
        {.way = way_of(s.memory_width, s.scene.height, lines[0], more[1]), .cores = 1, .interlaced = true},
    };
    manners[0].reuse = choices % (EL_REUSES + 1);
    manners[0].cores = 1;
    manners[0].depth_prepass = (choices & 4) != 0 && can_draw_depth_first(&s);
    manners[1].cores = EL_WITH_WORKERS ? 1U + (choices >> 3) % MAX_CORES : 1U;
    m.show = &s;
    /* Neither samples nor stripes nor a single line are interlaced. */
    const bool is_sharp = s.scene.samples == 0 && s.stripes == EL_STRIPES_NONE;
    const unsigned ways = EL_WITH_INTERLACED && is_sharp && s.scene.height > 1 ? WAYS : WAYS - 1;
    for (unsigned i = 0; i < ways; i++) {
        play(&m, &manners[i], &outcomes[i]);
        if (i > 0) {
            expect_same(&s, &outcomes[0], &outcomes[i], manners[i].interlaced);
        }
    }
    m.frame = s.frames - 1;
    if (outcomes[0].init == EL_OK && outcomes[0].begin[m.frame] == EL_OK) {
        expect_picked(&m, &outcomes[0]);
    }
    return 0;
}
