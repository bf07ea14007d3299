/* painter_sampled.h: each triangle in turn, merged as in painter.c. Small ones are carried on with what they have been set up
 * to; others are set up again in each band. */
#include "frame/painter_sampled.h"

#include "frame/bands.h"
#include "frame/carrying.h"
#include "frame/debug_hooks.h"
#include "raster/gather.h"
#include "raster/small_sampled.h"

#if EL_WITH_SAMPLES

typedef struct sampled_state {
    el_carried head;
#if EL_WITH_SMALL_SAMPLED
    el_small_sampled triangle;
#endif
} sampled_state;

static el_sampled_target sampled_target(const el_painter *painter, const el_renderer *renderer, const el_target *target)
{
    const uint32_t words = EL_MIXED_WORDS(renderer->config.width) * (uint32_t)renderer->config.band_lines;
    return (el_sampled_target){
        .target = *target,
        .mixed = painter->samples,
        .samples = painter->samples + (words + 1U) / 2U * 2U,
        .count = renderer->config.samples,
    };
}

void el_painter_resolve_samples(el_painter *painter, const el_renderer *renderer)
{
    if (el_renderer_samples(renderer) == 1) {
        return;
    }
    const el_band *const buffer = &painter->bands[painter->current];
    const el_target target = {
        .colour = buffer->pixels,
        .depth = painter->depth[painter->current],
        .width = buffer->width,
        .y = buffer->y,
        .y_end = buffer->y + buffer->lines,
    };
    const el_sampled_target sampled = sampled_target(painter, renderer, &target);
    el_samples_resolve(&sampled);
}

/* Where the next triangle is set up: in a state, which it keeps when it reaches on. */
typedef struct sampled_place {
    sampled_state *state;
    uint16_t name;       /* 0: there is no memory for one */
    sampled_state spare; /* the place then */
} sampled_place;

static void find_sampled_place(sampled_place *place, el_carrying *c, const el_list *list)
{
    place->name = EL_WITH_CARRY ? el_carrying_take(c, list, EL_STATE_SAMPLED, sizeof(sampled_state)) : 0;
    place->state = place->name != 0 ? el_list_at(list, place->name) : &place->spare;
}

/* As draw_named, with several samples per pixel. */
static uint16_t draw_sampled(el_painter *painter, const el_renderer *renderer, uint16_t name,
                             const el_sampled_target *target, sampled_place *place)
{
    const el_list *const list = &renderer->list;
#if EL_WITH_SMALL_SAMPLED
    if (name >= painter->carrying.first_state) {
        sampled_state *const state = el_list_at(list, name);
        if (el_small_sampled_go_on(&state->triangle, target, painter->stats) && painter->goes_on) {
            return name;
        }
        el_carrying_give(&painter->carrying, list, EL_STATE_SAMPLED, name);
        return 0;
    }
    el_small_sampled *const triangle = &place->state->triangle;
#else
    el_small_sampled *const triangle = NULL;
#endif
    el_corner corners[3];
    el_surface surface;
    el_count(&painter->stats->vertices, el_list_gather(list, el_list_record(list, name), corners, &surface));
    el_count(&painter->stats->setups, 1);
    surface.uv_error_log2 = renderer->config.uv_error_log2;
    el_debug_surface(renderer, el_list_record(list, name), &surface);
    const el_sampled_rest rest = el_sampled_draw(corners, &surface, target, painter->stats, triangle);
    if (rest == EL_SAMPLED_DONE || !painter->goes_on) {
        return 0;
    }
    if (rest == EL_SAMPLED_GOES_ON || place->name == 0) {
        return name;
    }
    const uint16_t carried = place->name;
    place->state->head.order = name;
    find_sampled_place(place, &painter->carrying, list);
    return carried;
}

void el_painter_draw_samples(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh,
                             uint16_t carried)
{
    const el_list *const list = &renderer->list;
    el_carrying *const c = &painter->carrying;
    const el_sampled_target sampled = sampled_target(painter, renderer, target);
    sampled_place place;
    find_sampled_place(&place, c, list);
    uint16_t *last = &c->first;
    while (fresh != 0 || carried != 0) {
        const uint16_t listed = el_carrying_next(c, list, &fresh, &carried);
        const uint16_t name = draw_sampled(painter, renderer, listed, &sampled, &place);
        if (name != 0) {
            *last = name;
            last = el_list_at(list, name);
        }
    }
    *last = 0;
    if (place.name != 0) {
        el_carrying_give(c, list, EL_STATE_SAMPLED, place.name);
    }
}

#endif
