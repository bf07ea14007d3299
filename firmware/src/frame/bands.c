#include "frame/bands.h"

#include "base/fill.h"
#include "base/fixed.h"
#include "frame/debug_hooks.h"
#include "frame/quiet.h"

/* Triangles that reach beyond the band in which they begin are carried on: their set-up state lives in what the list
 * has left of its memory, and their records form one list in the order of submission. Where there is no room for a
 * state, the triangle is set up anew in every band: slower, with the same pixels. */
typedef struct states {
    uint32_t used;                              /* end of the memory handed out so far, bytes from the list's base */
    uint16_t given_back[EL_SHADE_OVERDRAW + 1]; /* by shading; each begins with the next one's name; 0: none */
} states;

static uint16_t take_state(states *pool, const el_list *list, el_shading shading)
{
    const uint16_t reused = pool->given_back[shading];
    if (reused != 0) {
        pool->given_back[shading] = *(const uint16_t *)el_list_at(list, reused);
        return reused;
    }
    const uint32_t bytes = EL_ROUND_UP_8(el_triangle_bytes(shading));
    if (bytes > list->end || pool->used > list->end - bytes) {
        return 0;
    }
    const uint16_t name = (uint16_t)(pool->used / EL_LIST_UNIT);
    pool->used += bytes;
    return name;
}

static void give_state(states *pool, const el_list *list, el_shading shading, uint16_t name)
{
    *(uint16_t *)el_list_at(list, name) = pool->given_back[shading];
    pool->given_back[shading] = name;
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
        band->held[i] = el_quiet_taker(renderer, i) != NULL;
    }
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        const el_sink *const sink = el_quiet_taker(renderer, i);
        if (sink != NULL) {
            sink->rows(sink->context, band, i);
        }
    }
    el_count(&renderer->stats.bands, 1);
    renderer->current ^= 1U;
    renderer->band_is_open = 0;
}

/* Draws one record's triangle into the target. Returns whether it reaches beyond. A triangle that does is set up where its
 * state will stay. */
static bool draw_record(el_renderer *renderer, el_record *record, const el_target *target, states *pool)
{
    el_list *const list = &renderer->list;
    el_triangle local;
    el_triangle *triangle = &local;
    uint16_t state = 0;
    if (EL_WITH_CARRY && record->index == EL_INDEX_ACTIVE) {
        state = record->at.state;
        triangle = el_list_at(list, state);
    } else {
        el_corner corners[3];
        el_surface surface;
        el_count(&renderer->stats.vertices, el_list_gather(list, record, corners, &surface));
        surface.uv_error_log2 = renderer->config.uv_error_log2;
        el_debug_surface(renderer, record, &surface);
        el_count(&renderer->stats.setups, 1);
        const int32_t y_last = el_max_i32(corners[0].y, el_max_i32(corners[1].y, corners[2].y));
        if (EL_WITH_CARRY && el_first_centre(y_last) > target->y_end) {
            state = take_state(pool, list, surface.shading);
            triangle = state != 0 ? el_list_at(list, state) : &local;
        }
        if (!el_triangle_setup(triangle, corners, &surface, target->y)) {
            if (state != 0) {
                give_state(pool, list, surface.shading, state);
            }
            return false;
        }
        if (state != 0) {
            record->index = EL_INDEX_ACTIVE;
            record->at.state = state;
        }
    }
    el_triangle_draw(triangle, target, &renderer->stats);
    const bool reaches_on = triangle->y_end > target->y_end;
    if (!reaches_on && state != 0) {
        give_state(pool, list, triangle->surface.shading, state);
    }
    return reaches_on;
}

/* Draws the band's own triangles and those carried on from above, merged in the order of submission. Returns the list
 * of those that reach on. */
static uint16_t draw_band(el_renderer *renderer, uint16_t band, const el_target *target, uint16_t carried, states *pool)
{
    el_list *const list = &renderer->list;
    uint16_t fresh = el_list_take_bin(list, band);
    uint16_t first = 0;
    uint16_t last = 0;
    while (fresh != 0 || carried != 0) {
        uint16_t name;
        el_record *record;
        if (carried == 0 || (fresh != 0 && fresh < carried)) {
            name = fresh;
            record = el_list_at(list, name);
            fresh = record->next;
        } else {
            name = carried;
            record = el_list_at(list, name);
            carried = record->next;
        }
        if (!draw_record(renderer, record, target, pool)) {
            continue;
        }
        record->next = 0;
        if (last == 0) {
            first = name;
        } else {
            ((el_record *)el_list_at(list, last))->next = name;
        }
        last = name;
    }
    return first;
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
    el_list *const list = &renderer->list;
    states pool = {.used = list->used};
    uint16_t carried = 0;
    for (uint16_t band = renderer->pass_begin; band < renderer->pass_end; band++) {
        const bool is_empty = !renderer->band_is_open && carried == 0 && list->bins[band] == 0;
        if (hand_over_bands && el_quiet_leaves_out(renderer, band, is_empty)) {
            continue;
        }
        const el_target target = open_band(renderer, band);
        carried = draw_band(renderer, band, &target, carried, &pool);
        if (hand_over_bands) {
            hand_over(renderer);
        }
    }
    el_bands_note_use(renderer, pool.used);
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
