/* A pass over a single band, of one line, that stays open: what is submitted is drawn at once, and the pixel tells whether
 * it came through. Surfaces are flat and white here, because no shading changes what is covered, or its depth. */
#include "frame/pick.h"

#include "frame/bands.h"

enum { WHITE = 0xFFFF, NOTHING = 0xFFFF };

el_status el_pick_begin(el_pick *pick, const el_camera *camera, uint16_t width, uint16_t height, uint16_t x, uint16_t y,
                        void *memory, size_t memory_bytes)
{
    if (pick == NULL || x >= width || y >= height) {
        return EL_ERROR_ARGUMENT;
    }
    const el_config config = {
        .width = width, .height = height, .band_lines = 1, .memory = memory, .memory_bytes = memory_bytes};
    el_renderer *const renderer = &pick->renderer;
    renderer->in_frame = 0;
    el_status status = el_init(renderer, &config);
    if (status == EL_OK) {
        status = el_frame_begin(renderer, camera);
    }
    renderer->pass_begin = y;
    renderer->pass_end = (uint16_t)(y + 1U);
    pick->x = x;
    pick->draws = 0;
    pick->mesh = NULL;
    return status;
}

/* In the open band. */
static uint16_t *colour_of(const el_pick *pick)
{
    const el_painter *const painter = &pick->renderer.painter;
    return &painter->bands[painter->current].pixels[pick->x];
}

static uint16_t *depth_of(const el_pick *pick)
{
    const el_painter *const painter = &pick->renderer.painter;
    return &painter->depth[painter->current][pick->x];
}

/* Draws the triangles [begin, end) over what is there; *is_drawn: whether the pixel got one of them. */
static el_status draw(el_pick *pick, const el_mesh *mesh, uint32_t begin, uint32_t end, const el_pose *pose,
                      uint8_t flags, bool *is_drawn)
{
    el_mesh part = *mesh;
    part.colours = NULL;
    part.triangle_colours = NULL;
    if (begin > 0 || end < mesh->triangle_count) {
        part.triangles += begin;
        part.triangle_count = (uint16_t)(end - begin);
        part.cluster_count = 0;
    }
    const el_material white = {.flags = flags & (EL_MATERIAL_TWO_SIDED | EL_MATERIAL_NO_DEPTH),
                               .colour = {255, 255, 255}};
    const el_status status = el_draw(&pick->renderer, &part, pose, &white);
    el_bands_flush(&pick->renderer); /* nothing on the list names `part` and `white` any more */
    *is_drawn = *colour_of(pick) == WHITE;
    *colour_of(pick) = 0;
    return status;
}

el_status el_pick_draw(el_pick *pick, const el_mesh *mesh, const el_pose *pose, const el_material *material)
{
    if (pick == NULL || mesh == NULL) {
        return EL_ERROR_ARGUMENT;
    }
    const uint32_t number = pick->draws++;
    /* With the material as it is, and the mesh without its triangles: has it an error? */
    el_mesh empty = *mesh;
    empty.vertex_count = 0;
    empty.triangle_count = 0;
    empty.cluster_count = 0;
    el_status status = el_draw(&pick->renderer, &empty, pose, material);
    if (status != EL_OK) {
        return status;
    }
    bool is_drawn;
    status = draw(pick, mesh, 0, mesh->triangle_count, pose, material->flags, &is_drawn);
    if (is_drawn) {
        pick->mesh = mesh;
        pick->pose = *pose;
        pick->flags = material->flags;
        pick->best = (el_picked){.draw = number, .depth = *depth_of(pick)};
    }
    return status;
}

/* Of the best draw call's triangles, the first that has the pixel's depth in the end; or, without depth, the last that covers
 * it. Each half that is drawn tells whether it is there, whatever is before it. */
static uint32_t find_triangle(el_pick *pick)
{
    const bool has_depth = (pick->flags & EL_MATERIAL_NO_DEPTH) == 0;
    uint32_t begin = 0;
    uint32_t end = pick->mesh->triangle_count;
    while (end - begin > 1) {
        const uint32_t middle = (begin + end) / 2;
        bool is_drawn;
        *depth_of(pick) = NOTHING;
        if (has_depth) {
            (void)draw(pick, pick->mesh, begin, middle, &pick->pose, pick->flags, &is_drawn);
            is_drawn = is_drawn && *depth_of(pick) == pick->best.depth;
        } else {
            (void)draw(pick, pick->mesh, middle, end, &pick->pose, pick->flags, &is_drawn);
        }
        if (is_drawn == has_depth) {
            end = middle;
        } else {
            begin = middle;
        }
    }
    return begin;
}

int el_pick_end(el_pick *pick, el_picked *picked)
{
    if (pick == NULL || picked == NULL || !pick->renderer.in_frame) {
        return EL_ERROR_ARGUMENT;
    }
    const bool is_found = pick->mesh != NULL;
    if (is_found) {
        pick->best.triangle = find_triangle(pick);
        *picked = pick->best;
    }
    pick->renderer.in_frame = 0;
    return is_found;
}
