/* painter_field.h: each triangle in turn, merged as in painter.c, by the general set-up alone. */
#include "frame/painter_field.h"

#include "base/fixed.h"
#include "frame/carrying.h"
#include "raster/field.h"
#include "raster/gather.h"
#include "raster/wires.h"

#if EL_WITH_INTERLACED

typedef struct field_state {
    el_carried head;
    el_triangle triangle;
} field_state;

static uint16_t take_state(el_carrying *c, const el_list *list, el_shading shading)
{
    return el_carrying_take(c, list, (el_state_kind)shading,
                            offsetof(field_state, triangle) + el_triangle_bytes(shading));
}

static void give_state(el_carrying *c, const el_list *list, el_shading shading, uint16_t name)
{
    el_carrying_give(c, list, (el_state_kind)shading, name);
}

/* Whether what ends at `y`, 1/EL_SUBPIXELS px, has lines below the target. */
static bool reaches_on(const el_painter *painter, const el_target *target, int32_t y)
{
    return painter->goes_on && el_field_row(target->field, el_first_centre(y)) > target->y_end;
}

/* A record's triangle, from its corners. */
static uint16_t draw_fresh(el_painter *painter, const el_renderer *renderer, uint16_t name, const el_target *target)
{
    const el_list *const list = &renderer->list;
    const el_record *const record = el_list_record(list, name);
    el_carrying *const c = &painter->carrying;
    el_corner corners[3];
    el_surface surface;
    el_count(&painter->stats->vertices, el_list_gather(list, record, corners, &surface));
    el_count(&painter->stats->setups, 1);
    surface.uv_error_log2 = renderer->config.uv_error_log2;
    const int32_t y_last = el_max3_i32(corners[0].y, corners[1].y, corners[2].y);
#if EL_WITH_WIRES
    if ((surface.finish & EL_FINISH_WIRES) != 0) {
        surface.colour = el_wires_colour(list, record);
        el_wires_draw(corners, el_wires_of(list, record), &surface, target, painter->stats);
        return reaches_on(painter, target, y_last + EL_WIRE_REACH) ? name : 0;
    }
#endif
    el_triangle local;
    el_triangle *triangle = &local;
    const bool is_carried = reaches_on(painter, target, y_last);
    const uint16_t state_name = EL_WITH_CARRY && is_carried ? take_state(c, list, surface.shading) : 0;
    if (state_name != 0) {
        field_state *const state = el_list_at(list, state_name);
        state->head.order = name;
        triangle = &state->triangle;
    }
    if (!el_field_setup(triangle, corners, &surface, target->y, target->field)) {
        if (state_name != 0) {
            give_state(c, list, surface.shading, state_name);
        }
        return 0;
    }
    el_triangle_draw(triangle, target, painter->stats);
    if (!is_carried) {
        return 0;
    }
    return state_name != 0 ? state_name : name;
}

static uint16_t draw_carried(el_painter *painter, const el_list *list, uint16_t name, const el_target *target)
{
    el_triangle *const triangle = &((field_state *)el_list_at(list, name))->triangle;
    el_triangle_draw(triangle, target, painter->stats);
    if (painter->goes_on && !el_triangle_is_done(triangle)) {
        return name;
    }
    give_state(&painter->carrying, list, triangle->surface.shading, name);
    return 0;
}

void el_painter_draw_field(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh,
                           uint16_t carried)
{
    const el_list *const list = &renderer->list;
    el_carrying *const c = &painter->carrying;
    uint16_t *last = &c->first;
    while (fresh != 0 || carried != 0) {
        const uint16_t listed = el_carrying_next(c, list, &fresh, &carried);
        const uint16_t name = EL_WITH_CARRY && listed >= c->first_state ? draw_carried(painter, list, listed, target)
                                                                        : draw_fresh(painter, renderer, listed, target);
        if (name != 0) {
            *last = name;
            last = el_list_at(list, name);
        }
    }
    *last = 0;
}

#endif
