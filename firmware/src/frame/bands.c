#include "frame/bands.h"

#include "base/fill.h"
#include "base/fixed.h"
#include "frame/debug_hooks.h"

/* Triangles that reach beyond the band in which they begin are carried on: their set-up state lives in what the list
 * has left of its memory. Where there is no room for a state, the triangle is set up anew in every band: slower, with the
 * same pixels. What is carried is a chain in the order of submission, of states and of such records, whose name tells
 * which it is: states lie behind the list. Each begins with the name of the next one. */
typedef struct carried_state {
    uint16_t next;
    uint16_t record;
    el_triangle triangle;
} carried_state;

typedef struct carrying {
    uint16_t first;                             /* of the chain; 0: none */
    uint16_t first_state;                       /* names from here on are states */
    uint32_t used;                              /* end of the memory handed out so far, bytes from the list's base */
    uint16_t given_back[EL_SHADE_OVERDRAW + 1]; /* by shading; each begins with the next one's name; 0: none */
} carrying;

enum { NO_ORDER = 0xFFFF }; /* after all names: a list ends before that unit */

static uint16_t take_state(carrying *c, const el_list *list, el_shading shading)
{
    const uint16_t reused = c->given_back[shading];
    if (reused != 0) {
        c->given_back[shading] = *(const uint16_t *)el_list_at(list, reused);
        return reused;
    }
    const uint32_t bytes = EL_LIST_BYTES(offsetof(carried_state, triangle) + el_triangle_bytes(shading));
    if (bytes > list->end - c->used) {
        return 0;
    }
    const uint16_t name = (uint16_t)(c->used / EL_LIST_UNIT);
    c->used += bytes;
    return name;
}

static void give_state(carrying *c, const el_list *list, el_shading shading, uint16_t name)
{
    *(uint16_t *)el_list_at(list, name) = c->given_back[shading];
    c->given_back[shading] = name;
}

/* The place of something carried in the order of submission. */
static inline uint16_t order_of(const carrying *c, const el_list *list, uint16_t name)
{
    if (name == 0) {
        return NO_ORDER;
    }
    return name < c->first_state ? name : ((const carried_state *)el_list_at(list, name))->record;
}

static void wait_for(const el_renderer *renderer, const el_band *band)
{
    while (!el_band_is_free(band)) {
        for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
            const el_sink *const sink = renderer->config.sinks[i];
            if (sink != NULL && sink->wait != NULL) {
                sink->wait(sink->context);
            }
        }
    }
}

/* Makes `band` of the screen the one that is drawn into. */
static el_target open_band(el_renderer *renderer, uint16_t band)
{
    const el_config *const config = &renderer->config;
    el_band *const buffer = &renderer->bands[renderer->current];
    const int32_t y = band * config->band_lines;
    const int32_t y_end = el_min_i32(y + config->band_lines, config->height);
    if (!renderer->band_is_open) {
        wait_for(renderer, buffer);
        buffer->y = (uint16_t)y;
        buffer->lines = (uint16_t)(y_end - y);
        const uint32_t pixels = (uint32_t)buffer->lines * config->width;
        el_fill_u16(buffer->pixels, el_debug_begin_band(renderer), pixels);
        el_fill_u16(renderer->depth, 0xFFFF, pixels);
        renderer->band_is_open = 1;
    }
    return (el_target){
        .colour = buffer->pixels, .depth = renderer->depth, .width = config->width, .y = y, .y_end = y_end};
}

static void hand_over(el_renderer *renderer)
{
    el_band *const band = &renderer->bands[renderer->current];
    el_debug_finish_band(renderer, band);
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        band->held[i] = renderer->config.sinks[i] != NULL;
    }
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        const el_sink *const sink = renderer->config.sinks[i];
        if (sink != NULL) {
            sink->rows(sink->context, band, i);
        }
    }
    el_count(&renderer->stats.bands, 1);
    renderer->current ^= 1U;
    renderer->band_is_open = 0;
}

/* Sets up a record's triangle and draws it into the target. A triangle that reaches beyond is set up where its state will
 * stay. Returns the name under which it is carried on; 0 when it is not. */
static uint16_t draw_record(el_renderer *renderer, uint16_t name, const el_target *target, carrying *c)
{
    const el_list *const list = &renderer->list;
    const el_record *const record = el_list_at(list, name);
    el_triangle local;
    el_triangle *triangle = &local;
    uint16_t state_name = 0;
    el_corner corners[3];
    el_surface surface;
    el_count(&renderer->stats.vertices, el_list_gather(list, record, corners, &surface));
    surface.uv_error_log2 = renderer->config.uv_error_log2;
    el_debug_surface(renderer, record, &surface);
    el_count(&renderer->stats.setups, 1);
    const int32_t y_last = el_max_i32(corners[0].y, el_max_i32(corners[1].y, corners[2].y));
    const bool reaches_on = el_first_centre(y_last) > target->y_end;
    if (EL_WITH_CARRY && reaches_on) {
        state_name = take_state(c, list, surface.shading);
        if (state_name != 0) {
            carried_state *const state = el_list_at(list, state_name);
            state->record = name;
            triangle = &state->triangle;
        }
    }
    if (!el_triangle_setup(triangle, corners, &surface, target->y)) {
        if (state_name != 0) {
            give_state(c, list, surface.shading, state_name);
        }
        return 0;
    }
    el_triangle_draw(triangle, target, &renderer->stats);
    if (!reaches_on) {
        return 0;
    }
    return state_name != 0 ? state_name : name;
}

/* Draws what is carried on under that name. Returns the name under which it is carried on further; 0 when it is not. */
static uint16_t draw_carried(el_renderer *renderer, uint16_t name, const el_target *target, carrying *c)
{
    if (!EL_WITH_CARRY || name < c->first_state) {
        return draw_record(renderer, name, target, c);
    }
    el_triangle *const triangle = &((carried_state *)el_list_at(&renderer->list, name))->triangle;
    el_triangle_draw(triangle, target, &renderer->stats);
    if (triangle->y_end > target->y_end) {
        return name;
    }
    give_state(c, &renderer->list, triangle->surface.shading, name);
    return 0;
}

/* Draws the band's own triangles and those carried on from above, merged in the order of submission. Those that reach on
 * are the new chain. */
static void draw_band(el_renderer *renderer, uint16_t band, const el_target *target, carrying *c)
{
    el_list *const list = &renderer->list;
    uint16_t fresh = el_list_take_bin(list, band);
    uint16_t carried = c->first;
    uint16_t carried_order = order_of(c, list, carried);
    uint16_t *last = &c->first;
    for (;;) {
        uint16_t name;
        if ((fresh == 0 ? NO_ORDER : fresh) < carried_order) {
            const uint16_t next = *(const uint16_t *)el_list_at(list, fresh);
            name = draw_record(renderer, fresh, target, c);
            fresh = next;
        } else if (carried != 0) {
            const uint16_t next = *(const uint16_t *)el_list_at(list, carried);
            name = draw_carried(renderer, carried, target, c);
            carried = next;
            carried_order = order_of(c, list, carried);
        } else {
            break;
        }
        if (name != 0) {
            *last = name;
            last = el_list_at(list, name);
        }
    }
    *last = 0;
}

void el_bands_note_use(el_renderer *renderer, uint32_t bytes)
{
    const uint32_t use = renderer->fixed_bytes + bytes;
    if (EL_WITH_STATS && use > renderer->stats.memory_peak) {
        renderer->stats.memory_peak = use;
    }
}

static void draw_pass(el_renderer *renderer, bool hand_over_bands)
{
    const el_list *const list = &renderer->list;
    carrying c = {.first_state = (uint16_t)(list->used / EL_LIST_UNIT), .used = list->used};
    for (uint16_t band = renderer->pass_begin; band < renderer->pass_end; band++) {
        const el_target target = open_band(renderer, band);
        draw_band(renderer, band, &target, &c);
        if (hand_over_bands) {
            hand_over(renderer);
        }
    }
    el_bands_note_use(renderer, c.used);
}

void el_bands_flush(el_renderer *renderer)
{
    el_count(&renderer->stats.flushes, 1);
    draw_pass(renderer, false);
    el_list_clear(&renderer->list);
}

void el_bands_finish(el_renderer *renderer)
{
    draw_pass(renderer, true);
    el_list_clear(&renderer->list);
}
