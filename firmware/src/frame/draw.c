/* el_draw: from a mesh to records on the display list. */
#include <string.h>

#include "base/fixed.h"
#include "frame/bands.h"
#include "frame/cull.h"
#include "frame/debug_hooks.h"
#include "frame/drawing.h"
#include "frame/quiet.h"
#include "geometry/clip.h"
#include "raster/fog.h"
#include "raster/gather.h"
#include "raster/texture.h"
#include "raster/wires.h"

/* Attributes of corners that are cut; those of wires are their weights. */
enum { U, V, RGB };

/* The rows of the pass, which make_room may have made fewer. */
static void find_rows(el_drawing *d)
{
    const el_renderer *const renderer = d->renderer;
    d->culling.row_begin = renderer->pass_begin * renderer->config.band_lines;
    d->culling.row_end = el_min_i32(renderer->pass_end * renderer->config.band_lines, el_renderer_lines(renderer));
}

/* The list is full. Closes its gaps; where it has none, makes it thin; where it is that already, gives up the last
 * sixteenth of the pass' bands; where there is one band only, draws the list. Returns true when vertices that lay over
 * the depth band are lost, because the band's depth is there now. */
static bool make_room(el_renderer *renderer)
{
    const int32_t bands = renderer->pass_end - renderer->pass_begin;
    el_bands_note_use(renderer, renderer->list.used + renderer->list_bytes - renderer->list.end);
    const int32_t lines = renderer->config.band_lines;
    if (EL_WITH_WORKERS && renderer->list.has_gaps) {
        el_list_keep_rows(&renderer->list, renderer->pass_begin * lines, renderer->pass_end * lines);
        return false;
    }
#if EL_WITH_THIN
    if (bands > 1 && !renderer->list.is_thin) {
        el_list_make_thin(&renderer->list, renderer->pass_begin * lines);
        return false;
    }
#endif
    if (bands > 1) {
        renderer->pass_end = (uint16_t)(renderer->pass_begin + bands * 15 / 16);
        el_list_keep_rows(&renderer->list, renderer->pass_begin * lines, renderer->pass_end * lines);
        return false;
    }
    const bool was_open = renderer->painter.band_is_open;
    el_bands_flush(renderer);
    return !was_open;
}

static void fill_clipped(el_record *record, const el_draw_state *draw, const el_clip_corner *const corners[3])
{
    el_record_clipped *const clipped = (el_record_clipped *)(void *)record;
#if EL_WITH_WIRES
    if (el_draws_wires(draw)) {
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the same as below. */
        const int32_t *const weights[3] = {corners[0]->attributes, corners[1]->attributes, corners[2]->attributes};
        clipped->edges = (uint8_t)el_wires_of_piece(el_mesh_edges(draw->mesh, record->index), weights);
        return;
    }
#endif
    (void)draw;
    for (unsigned i = 0; i < 3; i++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a clipped record is made of a triangle that was cut. */
        const int32_t *const a = corners[i]->attributes;
        el_attributes *const attributes = &clipped->attributes[i];
        *attributes = (el_attributes){.u_q16 = a[U], .v_q16 = a[V]};
        for (unsigned channel = 0; channel < 3 && EL_WITH_GOURAUD; channel++) {
            attributes->rgb_q8[channel] = (uint16_t)a[RGB + channel];
        }
    }
}

/* A triangle on the screen: culls it, or puts it on the list. `cut` has the corners of a clipped one, else NULL. */
static void add_triangle(el_drawing *d, uint16_t index, const el_screen_vertex *const v[3],
                         const el_clip_corner *const cut[3])
{
#if !EL_SMALL_CODE
    el_screen_vertex copies[3];
    const el_screen_vertex *const kept[3] = {&copies[0], &copies[1], &copies[2]};
#endif
    for (;;) {
        el_cull_rows rows;
        const el_verdict verdict = el_cull(&d->culling, v, &rows);
        if (verdict == EL_VERDICT_SEEN) {
            const el_record_kind kind = cut != NULL ? d->cut_kind : el_drawing_kind(d);
            const int32_t row_end = el_min_i32(rows.end, d->culling.row_end);
            el_record *const record = el_list_append(d->list, d->state, kind, rows.begin, row_end);
            if (record == NULL) {
#if !EL_SMALL_CODE
                /* Their place may be needed. */
                for (unsigned i = 0; i < 3; i++) {
                    copies[i] = *v[i];
                }
                v = kept;
#endif
                if (make_room(d->renderer)) {
                    el_vertices_place(d);
                }
                find_rows(d);
                continue;
            }
            el_fill_record(record, index, v, kind, rows.first);
            if (EL_CLIP_ATTRIBUTES > 0 && kind == EL_RECORD_CLIPPED) {
                fill_clipped(record, d->state, cut);
            }
        }
        d->verdicts[verdict]++;
        return;
    }
}

/* Which side of the triangle the camera sees, before it is cut: the light needs it. */
static bool seen_from_back(const el_draw_state *draw, const el_clip_vertex v[3])
{
    /* Sign of the determinant of the (x, y, w) rows, with 19 bits of each, so that it stays below 2^60 whatever they
     * hold. What is turned by less looks alike lit from either side. */
    const int32_t rows[3][3] = {{v[0].x, v[0].y, v[0].w}, {v[1].x, v[1].y, v[1].w}, {v[2].x, v[2].y, v[2].w}};
    return el_determinant_is_negative(rows, 12) != ((draw->flags & EL_DRAW_MIRRORED) != 0);
}

/* A corner from which a fan has triangles of one winding. Snapping can dent a cut polygon by a sub-pixel; from the wrong
 * corner a fan folds over there, and its part that faces away would be culled while its neighbour covers too much. */
static unsigned fan_root(const el_screen_vertex screen[], unsigned count)
{
    for (unsigned root = 0; root < count; root++) {
        bool clockwise = false;
        bool counter_clockwise = false;
        for (unsigned i = 2; i < count; i++) {
            const el_screen_vertex *const b = &screen[(root + i - 1) % count];
            const el_screen_vertex *const c = &screen[(root + i) % count];
            const int32_t x[3] = {screen[root].x, b->x, c->x};
            const int32_t y[3] = {screen[root].y, b->y, c->y};
            const int64_t area = el_doubled_area(x, y);
            clockwise = clockwise || area > 0;
            counter_clockwise = counter_clockwise || area < 0;
        }
        if (!(clockwise && counter_clockwise)) {
            return root;
        }
    }
    return 0;
}

static EL_APART_IF_SMALL void clip_triangle(el_drawing *d, uint16_t index, uint8_t codes)
{
    const uint16_t *const vertices = d->mesh->triangles[index];
    const el_material *const material = d->state->material;
    const bool coloured = el_has_colours((el_shading)material->shading);
    el_clip_corner corners[EL_CLIP_MAX_VERTICES];
    el_clip_vertex clip[3];
    for (unsigned i = 0; i < 3; i++) {
        clip[i] = el_transform_position(&d->state->transform, d->mesh->positions[vertices[i]]);
    }
    const bool turned = coloured && el_is_lit(material) && (material->flags & EL_MATERIAL_TWO_SIDED) != 0 &&
                        seen_from_back(d->state, clip);
    for (unsigned i = 0; i < 3; i++) {
        corners[i] = (el_clip_corner){.position = clip[i]};
#if EL_WITH_WIRES
        if (el_draws_wires(d->state)) {
            corners[i].attributes[i] = EL_WIRE_WEIGHT;
        }
#endif
        if (el_has_texture((el_shading)material->shading)) {
            corners[i].attributes[U] = d->mesh->uvs[vertices[i]][0] * (1 << 12);
            corners[i].attributes[V] = d->mesh->uvs[vertices[i]][1] * (1 << 12);
        }
        if (coloured) {
            uint16_t rgb_q8[3];
            el_shade_vertex(d->state, vertices[i], turned, rgb_q8);
            for (unsigned channel = 0; channel < 3; channel++) {
                corners[i].attributes[RGB + channel] = rgb_q8[channel];
            }
        }
    }
    const unsigned count = el_clip_polygon(&d->state->transform, corners, 3, codes);
    d->clipped++;
    if (count == 0) {
        d->verdicts[EL_VERDICT_OUTSIDE]++;
        return;
    }
    el_screen_vertex screen[EL_CLIP_MAX_VERTICES];
    for (unsigned i = 0; i < count; i++) {
        el_project(&d->state->transform, &corners[i].position, &screen[i]);
    }
    const unsigned a = fan_root(screen, count);
    for (unsigned i = 2; i < count; i++) {
        const unsigned b = (a + i - 1) % count;
        const unsigned c = (a + i) % count;
        const el_screen_vertex *const fan[3] = {&screen[a], &screen[b], &screen[c]};
        const el_clip_corner *const cut[3] = {&corners[a], &corners[b], &corners[c]};
        add_triangle(d, index, fan, cut);
    }
}

/* Now a triangle needs them. Returns the bits of all three codes. */
static unsigned transform_later(const el_drawing *d, const uint16_t indices[3], el_screen_vertex *const v[3])
{
    unsigned codes = 0;
    for (unsigned i = 0; i < 3; i++) {
        if ((v[i]->code & EL_CODE_LATER) != 0) {
            el_transform_vertex(&d->state->transform, d->mesh->positions[indices[i]], v[i]);
        }
        codes |= v[i]->code;
    }
    return codes;
}

/* Any triangle. */
static void draw_triangle(el_drawing *d, uint32_t index)
{
    const uint16_t *const vertices = d->mesh->triangles[index];
    el_screen_vertex copies[3];
    el_screen_vertex *v[3];
#if EL_CULLS_IN_VIEW
    if (index < d->stretch_end) {
        v[0] = d->vertices + 3U * (index - d->stretch_begin);
        v[1] = v[0] + 1;
        v[2] = v[0] + 2;
    } else {
        el_vertices_clear_overlaid(d);
        el_vertices_find(d, vertices, v, copies);
    }
#else
    el_vertices_find(d, vertices, v, copies);
#endif
    if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) != 0) {
        d->verdicts[EL_VERDICT_OUTSIDE]++;
        return;
    }
    unsigned codes = v[0]->code | v[1]->code | v[2]->code;
    if (!EL_SMALL_CODE && (codes & EL_CODE_LATER) != 0) {
        codes = transform_later(d, vertices, v);
        if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) != 0) {
            d->verdicts[EL_VERDICT_OUTSIDE]++;
            return;
        }
    }
    if ((codes & EL_CODE_CLIP) != 0) {
        clip_triangle(d, (uint16_t)index, (uint8_t)codes);
    } else {
        add_triangle(d, (uint16_t)index, (const el_screen_vertex *const *)v, NULL);
    }
}

/* What any triangle takes of the list's memory at most. */
static uint32_t most_bytes(const el_list *list)
{
    const uint32_t shares = (list->bin_count / (uint32_t)EL_GROUP_BANDS + 1U) * el_list_record_bytes(EL_RECORD_THIN);
    return (EL_CLIP_MAX_VERTICES - 2) * (el_list_record_bytes(EL_RECORD_CLIPPED) + shares) +
           EL_LIST_BYTES(sizeof(el_run)) + EL_LIST_BYTES(EL_DRAW_STATE_BYTES);
}

#if !EL_WITH_WORKERS && !EL_WITH_CLUSTERS
static
#endif
    uint32_t
    el_drawing_run(el_drawing *d, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++) {
#if EL_CULLS_IN_VIEW
        i = el_drawing_list_in_view(d, i, end);
        if (i == end) {
            break;
        }
#endif
        if (EL_WITH_WORKERS && d->in_parts && d->list->end - d->list->used < most_bytes(d->list)) {
            return i;
        }
        draw_triangle(d, i);
    }
    return end;
}

/* Draws the triangles from number `begin` on, on this core alone: all of them, or of clusters those that may be seen. Returns how
 * many its clusters skipped. */
static EL_APART uint32_t run_alone(el_drawing *d, uint32_t begin)
{
    uint32_t skipped = 0;
#if EL_CULLS_IN_VIEW
    el_side sides[EL_SIDES];
    d->sides = sides;
#endif
    if (!EL_WITH_CLUSTERS || !d->by_clusters) {
        (void)el_drawing_run(d, begin, d->mesh->triangle_count);
    }
#if EL_WITH_CLUSTERS
    else {
        skipped = el_drawing_run_clusters(d);
    }
#endif
#if EL_CULLS_IN_VIEW
    d->sides = NULL;
#endif
    return skipped;
}

static void draw_triangles(el_drawing *d)
{
    const uint32_t count = d->mesh->triangle_count;
    uint32_t begin = 0;
#if EL_WITH_WORKERS
    if (!d->by_clusters) {
        begin = el_drawing_run_in_parts(d);
    }
#endif
    const uint32_t skipped = run_alone(d, begin);
    el_stats *const stats = &d->renderer->stats;
    el_count(&stats->vertices, d->transformed);
    el_count(&stats->triangles, count - skipped);
    el_count(&stats->triangles_skipped, skipped);
    el_count(&stats->triangles_outside, d->verdicts[EL_VERDICT_OUTSIDE]);
    el_count(&stats->triangles_clipped, d->clipped);
    el_count(&stats->triangles_backface, d->verdicts[EL_VERDICT_BACK]);
    el_count(&stats->triangles_empty, d->verdicts[EL_VERDICT_EMPTY]);
    el_count(&stats->triangles_other, d->verdicts[EL_VERDICT_OTHER]);
    el_count(&stats->triangles_listed, d->verdicts[EL_VERDICT_SEEN]);
}

/* The bits of el_shading that options.h leaves out. */
enum {
    LEFT_OUT = (EL_WITH_GOURAUD ? 0 : EL_SHADE_GOURAUD) | (EL_WITH_TEXTURE ? 0 : EL_SHADE_TEXTURED) |
               (EL_WITH_OVERDRAW ? 0 : EL_SHADE_OVERDRAW)
};

#if EL_WITH_MIXED
/* EL_FINISH_ of its surfaces, as it is shaded. */
static uint8_t finish_of(const el_material *material, el_shading shading)
{
    const bool is_mixed =
        shading != EL_SHADE_OVERDRAW && (el_is_blended(material) || material->fog != NULL ||
                                         (el_has_texture(shading) && el_texture_is_mixed(material->texture)));
    return (uint8_t)(el_dithering_of(material, shading) | (is_mixed ? EL_FINISH_MIXED : 0U));
}

/* Of a material that is good otherwise: whether what it is to be mixed with can be. */
static bool can_mix(const el_renderer *renderer, const el_material *material)
{
    if (material->fog != NULL && ((material->flags & EL_MATERIAL_NO_DEPTH) != 0 || !el_fog_is_made(material->fog) ||
                                  renderer->view.projection != EL_PERSPECTIVE)) {
        return false;
    }
    return !el_is_blended(material) || (material->flags & EL_MATERIAL_BLEND_DEPTH) == 0 ||
           !renderer->config.depth_prepass;
}
#endif

static inline bool wants_wires(const el_material *material, el_shading shading)
{
#if EL_WITH_WIRES
    return shading == EL_SHADE_FLAT && (material->flags & EL_MATERIAL_WIRES) != 0;
#else
    (void)material;
    (void)shading;
    return false;
#endif
}

#if EL_WITH_WIRES
/* Whether a material that is to draw wires can. */
static bool can_draw_wires(const el_renderer *renderer, const el_material *material)
{
#if EL_WITH_MIXED
    if (el_is_blended(material) || material->fog != NULL) {
        return false;
    }
#endif
    return material->shading == EL_SHADE_FLAT && (!EL_WITH_SAMPLES || renderer->list.reach == 0) &&
           !el_config_has_stripes(&renderer->config);
}
#endif

static el_status check(const el_renderer *renderer, const el_mesh *mesh, const el_material *material)
{
    if (mesh->triangle_count > EL_MESH_MAX_TRIANGLES) {
        return EL_ERROR_SIZE;
    }
    if (mesh->triangle_count > 0 && (mesh->positions == NULL || mesh->triangles == NULL)) {
        return EL_ERROR_ARGUMENT;
    }
    const unsigned shading = material->shading;
    if (shading > EL_SHADE_OVERDRAW || (shading & LEFT_OUT) != 0 ||
        (!EL_WITH_DITHER && (material->flags & EL_MATERIAL_DITHER) != 0) ||
        (!EL_WITH_LIGHT && material->light != NULL) ||
        (el_has_texture((el_shading)shading) &&
         (material->texture == NULL || mesh->uvs == NULL || !el_texture_is_good(material->texture))) ||
        (el_is_lit(material) && mesh->normals == NULL)) {
        return EL_ERROR_MATERIAL;
    }
#if EL_WITH_MIXED
    if (!can_mix(renderer, material)) {
        return EL_ERROR_MATERIAL;
    }
#endif
    if (EL_WITH_SAMPLES && shading == EL_SHADE_OVERDRAW && renderer->list.reach != 0) {
        return EL_ERROR_MATERIAL;
    }
#if EL_WITH_WIRES
    if ((material->flags & EL_MATERIAL_WIRES) != 0 && !can_draw_wires(renderer, material)) {
        return EL_ERROR_MATERIAL;
    }
#endif
    return EL_OK;
}

/* The light's direction in the model's space, by the transposed rotation. */
static void turn_light(el_draw_state *state, const el_material *material, const el_pose *pose)
{
    for (unsigned i = 0; i < 3; i++) {
        const int64_t component =
            el_shift_i64(el_dot_column(material->light->direction_q30, pose->rotation_q30, i), 46);
        state->light_q14[i] = (int16_t)(component > 16384 ? 16384 : (component < -16384 ? -16384 : component));
    }
}

el_status el_draw(el_renderer *renderer, const el_mesh *mesh, const el_pose *pose, const el_material *material)
{
    if (renderer == NULL || mesh == NULL || pose == NULL || material == NULL || !renderer->in_frame) {
        return EL_ERROR_ARGUMENT;
    }
    const el_status status = check(renderer, mesh, material);
    if (status != EL_OK) {
        return status;
    }
    el_count(&renderer->stats.draws, 1);
    if (el_quiet_looks(renderer)) {
        el_quiet_look_at(renderer, mesh, pose, material);
        return EL_OK;
    }
    el_draw_state state = {.mesh = mesh, .material = material};
    const int visibility = el_transform_make(&state.transform, &renderer->view, mesh, pose);
    if (visibility < 0) {
        el_quiet_refuse(renderer);
        return (el_status)visibility;
    }
    if (visibility == EL_CULLED) {
        el_count(&renderer->stats.draws_culled, 1);
        return EL_OK;
    }
    state.flags = state.transform.mirrored;
    if (el_is_lit(material)) {
        turn_light(&state, material, pose);
    }
    el_shading shading = (el_shading)material->shading;
    if (!el_debug_begin_draw(renderer, &state, &shading)) {
        return EL_OK;
    }
#if EL_WITH_MIXED
    state.flags |= finish_of(material, shading);
#endif
    const bool has_wires = wants_wires(material, shading);
    state.flags |= (uint8_t)(has_wires ? EL_FINISH_WIRES : 0);
    el_drawing d = {
        .renderer = renderer,
        .mesh = mesh,
        .state = &state,
        .list = &renderer->list,
        .kind = el_has_texture(shading) ? EL_RECORD_PERSPECTIVE : EL_RECORD_PLAIN,
        .cut_kind = el_has_texture(shading) || el_has_colours(shading) || has_wires ? EL_RECORD_CLIPPED : EL_RECORD_CUT,
        .culling = {.facing = state.transform.mirrored != 0 ? -1 : 1,
                    .two_sided = (material->flags & EL_MATERIAL_TWO_SIDED) != 0,
                    .width = renderer->config.width,
                    .height = renderer->config.height,
                    .reach = EL_WITH_SAMPLES ? renderer->list.reach : 0,
                    .field = el_list_field(&renderer->list)},
        .by_clusters = EL_WITH_CLUSTERS && mesh->cluster_count > 1,
    };
#if EL_WITH_WIRES
    if (has_wires) {
        d.culling.reach = EL_WIRE_REACH;
    }
#endif
#if EL_CULLS_IN_VIEW
    d.is_special = d.culling.reach != 0 || d.culling.field != EL_FIELD_NONE;
#endif
    el_list_end_draw(&renderer->list);
    /* Enough for a few vertices in the cache and for the largest record and its run beside them; an empty list has it. */
    while (renderer->list_bytes - renderer->list.used < EL_MIN_LIST_BYTES / 2) {
        (void)make_room(renderer);
    }
    find_rows(&d);
    el_vertices_place(&d);
    draw_triangles(&d);
    el_bands_note_use(renderer, renderer->list.used + renderer->list_bytes - renderer->list.end);
    renderer->list.end = renderer->list_bytes;
    return EL_OK;
}
