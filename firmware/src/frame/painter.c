/* A band's triangles, from the display list to pixels: those listed in it, merged with those carried on from above. */
#include "frame/bands.h"

#include "base/fill.h"
#include "base/fixed.h"
#include "frame/carrying.h"
#include "frame/debug_hooks.h"
#include "frame/painter_field.h"
#include "frame/painter_sampled.h"
#include "raster/gather.h"
#include "raster/hidden.h"
#include "raster/plain.h"
#include "raster/small_triangle.h"
#include "raster/tiny_triangle.h"
#include "raster/wires.h"

/* What is carried, see painter.h. */
typedef struct carried_state {
    el_carried head;
#if EL_WITH_SMALL_PLANES
    bool is_tiny; /* a tiny_state */
#endif
#if EL_WITH_HIDDEN
    uint16_t depth; /* of its nearest corner */
#endif
    el_triangle triangle;
} carried_state;

#if EL_WITH_SMALL_PLANES
/* Of tiny triangles: a carried_state up to there, in half the memory. */
typedef struct tiny_state {
    el_carried head;
    bool is_tiny;
    el_tiny_triangle triangle;
} tiny_state;
_Static_assert(offsetof(tiny_state, is_tiny) == offsetof(carried_state, is_tiny), "one may be asked for the other");
#endif

static uint32_t state_bytes(el_state_kind kind)
{
#if EL_WITH_SMALL_PLANES
    if (kind == EL_STATE_TINY) {
        return sizeof(tiny_state);
    }
#endif
    return offsetof(carried_state, triangle) + el_triangle_bytes((el_shading)kind);
}

static uint16_t take_state(el_carrying *c, const el_list *list, el_state_kind kind)
{
    return el_carrying_take(c, list, kind, state_bytes(kind));
}

#if EL_WITH_HIDDEN
/* Whether all of a triangle is behind what is drawn already; counts it. A view of what the depth test rejects wants to see
 * it all the same. */
static bool is_hidden(el_painter *painter, const el_target *target, const el_surface *surface, int32_t x_begin,
                      int32_t x_end, uint16_t depth)
{
    if (!surface->depth || surface->shading == EL_SHADE_OVERDRAW ||
        !el_hidden_is(painter->hidden, target, x_begin, x_end, depth)) {
        return false;
    }
    el_count(&painter->stats->triangles_hidden, 1);
    return true;
}

static uint16_t nearest(const el_corner corners[3])
{
    return (uint16_t)el_min3_i32(corners[0].z, corners[1].z, corners[2].z);
}
#endif

#if EL_WITH_WIRES
/* Draws the edges of a triangle; nothing of it is carried on but its name. As draw_any. */
static EL_SELDOM uint16_t draw_wires(el_painter *painter, const el_renderer *renderer, uint16_t name,
                                     const el_corner corners[3], el_surface *surface, const el_target *target)
{
    const el_list *const list = &renderer->list;
    const el_record *const record = el_list_record(list, name);
    surface->colour = el_wires_colour(list, record);
    el_debug_surface(renderer, record, surface);
    el_count(&painter->stats->setups, 1);
    el_wires_draw(corners, el_wires_of(list, record), surface, target, painter->stats);
    const int32_t y_last = el_max3_i32(corners[0].y, corners[1].y, corners[2].y);
    return painter->goes_on && el_first_centre(y_last + EL_WIRE_REACH) > target->y_end ? name : 0;
}
#endif

/* Sets up a record's triangle and draws it into the target. A triangle that reaches beyond is set up where its state will
 * stay. Returns the name under which it is carried on; 0 when it is not. */
static __attribute__((noinline)) uint16_t draw_any(el_painter *painter, const el_renderer *renderer, uint16_t name,
                                                   const el_target *target)
{
    const el_list *const list = &renderer->list;
    const el_record *const record = el_list_record(list, name);
    el_carrying *const c = &painter->carrying;
    el_triangle local;
    el_triangle *triangle = &local;
    uint16_t state_name = 0;
    el_corner corners[3];
    el_surface surface;
    el_count(&painter->stats->vertices, el_list_gather(list, record, corners, &surface));
#if EL_WITH_WIRES
    if ((surface.finish & EL_FINISH_WIRES) != 0) {
        return draw_wires(painter, renderer, name, corners, &surface, target);
    }
#endif
    el_debug_surface(renderer, record, &surface);
    const int32_t y_last = el_max3_i32(corners[0].y, corners[1].y, corners[2].y);
    const bool reaches_on = painter->goes_on && el_first_centre(y_last) > target->y_end;
#if EL_WITH_HIDDEN
    if (el_hidden_is_likely(painter->hidden, painter->stats) &&
        is_hidden(painter, target, &surface, el_first_centre(el_min3_i32(corners[0].x, corners[1].x, corners[2].x)),
                  el_first_centre(el_max3_i32(corners[0].x, corners[1].x, corners[2].x)), nearest(corners))) {
        return reaches_on ? name : 0;
    }
#endif
    surface.uv_error_log2 = renderer->config.uv_error_log2;
    el_count(&painter->stats->setups, 1);
    if (EL_WITH_CARRY && reaches_on) {
        state_name = take_state(c, list, (el_state_kind)surface.shading);
        if (state_name != 0) {
            carried_state *const state = el_list_at(list, state_name);
            state->head.order = name;
#if EL_WITH_SMALL_PLANES
            state->is_tiny = false;
#endif
#if EL_WITH_HIDDEN
            state->depth = nearest(corners);
#endif
            triangle = &state->triangle;
        }
    }
    if (!el_triangle_setup(triangle, corners, &surface, target->y)) {
        if (state_name != 0) {
            el_carrying_give(c, list, (el_state_kind)surface.shading, state_name);
        }
        return 0;
    }
    el_triangle_draw(triangle, target, painter->stats);
    if (!reaches_on) {
        return 0;
    }
    return state_name != 0 ? state_name : name;
}

#if EL_WITH_SMALL_PLANES
static __attribute__((noinline)) void look_at_run(el_run_look *look, const el_list *list, uint16_t run, int32_t width)
{
    *look = el_look_at_run(list, run, width);
}

/* Flat triangles that are small but not tiny, from their record to their pixels. */
static __attribute__((noinline)) uint16_t draw_small(el_painter *painter, const el_renderer *renderer, uint16_t name,
                                                     const el_record *record, const el_run_look *look,
                                                     const el_target *target)
{
    const el_list *const list = &renderer->list;
    const el_point *const points = record->at.points;
    const int32_t y_last = el_max3_i32(points[0].y, points[1].y, points[2].y);
    uint16_t state_name = 0;
    uint16_t carried_name = 0;
    el_triangle *rest = NULL;
    if (painter->goes_on && el_first_centre(y_last) > target->y_end) {
        carried_name = name;
        state_name = EL_WITH_CARRY ? take_state(&painter->carrying, list, (el_state_kind)EL_SHADE_FLAT) : 0;
        if (state_name != 0) {
            carried_state *const state = el_list_at(list, state_name);
            state->head.order = name;
            state->is_tiny = false;
#if EL_WITH_HIDDEN
            state->depth = (uint16_t)el_min3_i32(points[0].z, points[1].z, points[2].z);
#endif
            rest = &state->triangle;
            carried_name = state_name;
        }
    }
    if (el_small_triangle_draw(record, look, target, painter->stats, rest)) {
        el_count(&painter->stats->setups, 1);
        return carried_name;
    }
    if (state_name != 0) {
        el_carrying_give(&painter->carrying, list, (el_state_kind)EL_SHADE_FLAT, state_name);
    }
    return draw_any(painter, renderer, name, target);
}

/* Where the next tiny triangle is set up: in a state, which it keeps when it reaches on. */
typedef struct tiny_place {
    tiny_state *state;
    uint16_t name;    /* 0: there is no memory for one */
    tiny_state spare; /* the place then */
} tiny_place;

static inline void find_place(tiny_place *place, el_carrying *c, const el_list *list)
{
    place->name = EL_WITH_CARRY ? take_state(c, list, EL_STATE_TINY) : 0;
    place->state = place->name != 0 ? el_list_at(list, place->name) : &place->spare;
    place->state->is_tiny = true;
}

/* What becomes of a tiny triangle that has been drawn into the target: the name under which it is carried on, or 0. */
static inline uint16_t carry_tiny(el_painter *painter, const el_list *list, uint16_t name, el_tiny_result result,
                                  tiny_place *place)
{
    if (result == EL_TINY_DRAWN || !painter->goes_on) {
        return 0;
    }
    const uint16_t state_name = place->name;
    if (state_name == 0) {
        return name;
    }
    place->state->head.order = name;
    find_place(place, &painter->carrying, list);
    return state_name;
}

#if EL_WITH_THIN
/* As draw_record, of a run whose records have no corners. */
static __attribute__((noinline)) uint16_t draw_thin(el_painter *painter, const el_renderer *renderer, uint16_t name,
                                                    const el_target *target, const el_run_look *look, tiny_place *place)
{
    const el_list *const list = &renderer->list;
    el_run_look as_whole = *look;
    as_whole.flat = look->thin;
    el_record whole;
    el_list_make_whole(&whole, look->thin, el_list_record(list, name));
    el_count(&painter->stats->vertices, 3);
    const el_tiny_result result =
        el_tiny_triangle_draw(&whole, &as_whole, target, painter->stats, &place->state->triangle);
    if (result == EL_TINY_REFUSED) {
        return draw_small(painter, renderer, name, &whole, &as_whole, target);
    }
    return carry_tiny(painter, list, name, result, place);
}
#endif

/* Draws a record that is listed in this band: nearly all of a mesh without textures or vertex colours are done at once. As
 * draw_named. */
static inline uint16_t draw_record(el_painter *painter, const el_renderer *renderer, uint16_t name,
                                   const el_target *target, el_run_look *look, tiny_place *place)
{
    const el_list *const list = &renderer->list;
    const el_record *const record = el_list_record(list, name);
    if (record->run != look->run) {
        look_at_run(look, list, record->run, target->width);
    }
#if EL_WITH_HIDDEN
    const bool is_hiding = el_hidden_is_likely(painter->hidden, painter->stats);
#else
    const bool is_hiding = false;
#endif
    const bool is_other = is_hiding || look->flat == NULL;
    if (is_other) {
#if EL_WITH_THIN
        if (look->thin != NULL && !is_hiding) {
            return draw_thin(painter, renderer, name, target, look, place);
        }
#endif
        return draw_any(painter, renderer, name, target);
    }
    const el_tiny_result result = el_tiny_triangle_draw(record, look, target, painter->stats, &place->state->triangle);
    if (result == EL_TINY_REFUSED) {
        return draw_small(painter, renderer, name, record, look, target);
    }
    return carry_tiny(painter, list, name, result, place);
}

#if EL_WITH_HIDDEN
/* is_hidden for a carried triangle whose corners are in its record; a thin one has none, and is drawn. */
static __attribute__((noinline)) bool record_is_hidden(el_painter *painter, const el_list *list, uint16_t name,
                                                       const el_target *target)
{
    const el_record *const record = el_list_record(list, name);
    if (EL_WITH_THIN && el_list_run(list, record)->kind == EL_RECORD_THIN) {
        return false;
    }
    const el_point *const p = record->at.points;
    const int32_t x_begin = el_first_centre(el_min3_i32(p[0].x, p[1].x, p[2].x));
    const int32_t x_end = el_first_centre(el_max3_i32(p[0].x, p[1].x, p[2].x));
    const int32_t depth = el_min3_i32(p[0].z, p[1].z, p[2].z);
    if (!el_hidden_is(painter->hidden, target, x_begin, x_end, (uint16_t)depth)) {
        return false;
    }
    el_count(&painter->stats->triangles_hidden, 1);
    return true;
}
#endif

/* Draws what is carried on of a tiny triangle. As draw_named. */
static uint16_t draw_tiny(el_painter *painter, const el_renderer *renderer, uint16_t name, const el_target *target)
{
    const el_list *const list = &renderer->list;
    tiny_state *const state = el_list_at(list, name);
#if EL_WITH_HIDDEN
    if (el_hidden_is_likely(painter->hidden, painter->stats) &&
        record_is_hidden(painter, list, state->head.order, target)) {
        const uint16_t order = state->head.order;
        const bool reaches_on = painter->goes_on && state->triangle.rows > target->y_end - target->y;
        el_carrying_give(&painter->carrying, list, EL_STATE_TINY, name);
        return reaches_on ? order : 0;
    }
#endif
    if (el_tiny_triangle_go_on(&state->triangle, target, painter->stats) && painter->goes_on) {
        return name;
    }
    el_carrying_give(&painter->carrying, list, EL_STATE_TINY, name);
    return 0;
}
#endif

/* Draws a record's triangle, or what is carried on under that name. Returns the name under which it is carried on further;
 * 0 when it is not. */
static EL_APART_IF_SMALL uint16_t draw_named(el_painter *painter, const el_renderer *renderer, uint16_t name,
                                             const el_target *target)
{
    if (!EL_WITH_CARRY || name < painter->carrying.first_state) {
        return draw_any(painter, renderer, name, target);
    }
    carried_state *const state = el_list_at(&renderer->list, name);
#if EL_WITH_SMALL_PLANES
    if (state->is_tiny) {
        return draw_tiny(painter, renderer, name, target);
    }
#endif
    el_triangle *const triangle = &state->triangle;
    const bool reaches_on = painter->goes_on && triangle->y_end > target->y_end;
#if EL_WITH_HIDDEN
    if (el_hidden_is_likely(painter->hidden, painter->stats) &&
        is_hidden(painter, target, &triangle->surface, triangle->x_begin, triangle->x_end, state->depth)) {
        /* It is set up anew where it comes into sight, if it does. */
        const uint16_t order = state->head.order;
        el_carrying_give(&painter->carrying, &renderer->list, (el_state_kind)triangle->surface.shading, name);
        return reaches_on ? order : 0;
    }
#endif
    el_triangle_draw(triangle, target, painter->stats);
    if (reaches_on) {
        return name;
    }
    el_carrying_give(&painter->carrying, &renderer->list, (el_state_kind)triangle->surface.shading, name);
    return 0;
}

#if EL_WITH_PREPASS
/* Draws the depth alone of a record's triangle, or of one that is carried on. */
static void draw_depth(const el_painter *painter, const el_renderer *renderer, uint16_t name, const el_target *target,
                       el_stats *stats)
{
    const el_list *const list = &renderer->list;
    el_triangle triangle;
    if (EL_WITH_CARRY && name >= painter->carrying.first_state) {
        el_triangle_take_depth(&triangle, &((const carried_state *)el_list_at(list, name))->triangle);
    } else {
        el_corner corners[3];
        el_surface surface;
        stats->vertices += el_list_gather_depth(list, el_list_record(list, name), corners, &surface);
        if (!surface.depth || !el_triangle_setup(&triangle, corners, &surface, target->y)) {
            return;
        }
    }
    if (triangle.surface.depth) {
        el_triangle_draw(&triangle, target, stats);
    }
}

/* A pre-pass: the depth of all triangles, from the chains that begin with `fresh` and `carried`, and then a unit more for
 * every pixel. What is drawn afterwards passes the test with its own depth where nothing is nearer; the first that does
 * takes the unit off again, so each pixel is shaded once, and of equal depths the one that was submitted first stays.
 * Colours that are left behind are drawn over: a pixel with a depth gets its triangle's. */
static void draw_depth_first(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh,
                             uint16_t carried)
{
    el_stats stats = {0};
    for (uint16_t name = carried; name != 0; name = *(const uint16_t *)el_list_at(&renderer->list, name)) {
        draw_depth(painter, renderer, name, target, &stats);
    }
    for (uint16_t name = fresh; name != 0; name = *(const uint16_t *)el_list_at(&renderer->list, name)) {
        draw_depth(painter, renderer, name, target, &stats);
    }
    el_word *const words = (el_word *)(void *)target->depth;
    const uint32_t pixels = (uint32_t)((target->y_end - target->y) * target->width);
    for (uint32_t i = 0; i < (pixels + 1U) / 2U; i++) {
        words[i] += 0x10001U; /* FARTHEST at most in both halves: no carry */
    }
    el_count(&painter->stats->vertices, stats.vertices);
    el_count(&painter->stats->pixels_prepass, stats.pixels);
#if EL_WITH_HIDDEN
    painter->hidden->likely_from -= stats.pixels;
#endif
}
#endif

/* The band's own triangles and those carried on from above are merged in the order of submission. Those that reach on are
 * the new chain. */
void el_painter_draw(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh)
{
    const el_list *const list = &renderer->list;
    el_carrying *const c = &painter->carrying;
    uint16_t carried = c->first;
#if EL_WITH_SAMPLES
    if (el_renderer_samples(renderer) > 1) {
        el_painter_draw_samples(painter, renderer, target, fresh, carried);
        return;
    }
#endif
#if EL_WITH_INTERLACED
    if (target->field != EL_FIELD_NONE) {
        el_painter_draw_field(painter, renderer, target, fresh, carried);
        return;
    }
#endif
#if EL_WITH_HIDDEN
    el_hidden hidden;
    painter->hidden = &hidden;
    el_hidden_begin(&hidden, painter->stats, (uint32_t)((target->y_end - target->y) * target->width));
#endif
#if EL_WITH_PREPASS
    if (painter->first_depth) {
        draw_depth_first(painter, renderer, target, fresh, carried);
    }
#endif
    uint16_t *last = &c->first;
#if EL_WITH_SMALL_PLANES
    el_run_look look = {.run = 0};
    tiny_place place;
    const bool is_apart =
        (EL_WITH_DEBUG_VIEWS && renderer->config.view != EL_DEBUG_PICTURE) || renderer->config.depth_prepass;
    find_place(&place, c, list);
#endif
    uint16_t carried_order = el_carrying_order(c, list, carried);
    for (;;) {
        const bool is_fresh = el_is_earlier(fresh, carried_order);
        const uint16_t listed = is_fresh ? fresh : carried;
        if (listed == 0) {
            break;
        }
        const uint16_t next = *(const uint16_t *)el_list_at(list, listed);
#if EL_WITH_SMALL_PLANES
        const uint16_t name = is_fresh && !is_apart ? draw_record(painter, renderer, listed, target, &look, &place)
                                                    : draw_named(painter, renderer, listed, target);
#else
        const uint16_t name = draw_named(painter, renderer, listed, target);
#endif
        if (is_fresh) {
            fresh = next;
        } else {
            carried = next;
            carried_order = el_carrying_order(c, list, carried);
        }
        if (name != 0) {
            *last = name;
            last = el_list_at(list, name);
        }
    }
    *last = 0;
#if EL_WITH_SMALL_PLANES
    if (place.name != 0) {
        el_carrying_give(c, list, EL_STATE_TINY, place.name);
    }
#endif
#if EL_WITH_HIDDEN
    painter->hidden = NULL;
#endif
}
