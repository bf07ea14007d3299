#include "frame/quiet.h"

#include "base/fixed.h"
#include "base/hash.h"
#include "frame/bands.h"
#include "raster/fog.h"

#if EL_WITH_REUSE

/* A view counts what is drawn, bands without triangles included. */
static unsigned reuse_of(const el_renderer *renderer)
{
    return renderer->config.view == EL_DEBUG_PICTURE ? renderer->config.reuse : 0U;
}

/* --- What is submitted -------------------------------------------------------------------------------------------- */

static uint32_t hash_words(uint32_t hash, const int32_t *words, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        hash = el_hash_word(hash, (uint32_t)words[i]);
    }
    return hash;
}

static uint32_t hash_pointer(uint32_t hash, const volatile void *pointer)
{
    const uintptr_t address = (uintptr_t)pointer;
    hash = el_hash_word(hash, (uint32_t)address);
#if UINTPTR_MAX > UINT32_MAX
    hash = el_hash_word(hash, (uint32_t)(address >> 32));
#endif
    return hash;
}

static uint32_t hash_pair(uint32_t hash, uint32_t high, uint32_t low)
{
    return el_hash_word(hash, high << 16 ^ low);
}

static uint32_t hash_view(uint32_t hash, const el_view *view)
{
    hash = hash_words(hash, view->axes_q30[0], 9);
    hash = hash_words(hash, view->position_q16, 3);
    for (unsigned i = 0; i < 2; i++) {
        hash = el_hash_word(hash, view->focal[i].mantissa);
        hash = el_hash_word(hash, (uint32_t)view->focal[i].exponent);
    }
    hash = el_hash_word(hash, (uint32_t)view->projection);
    hash = el_hash_word(hash, view->near_q16);
    return el_hash_word(hash, view->far_q16);
}

static uint32_t hash_mesh(uint32_t hash, const el_mesh *mesh)
{
    hash = hash_pointer(hash, mesh->positions);
    hash = hash_pointer(hash, mesh->triangles);
    hash = hash_pointer(hash, mesh->colours);
    hash = hash_pointer(hash, mesh->triangle_colours);
    hash = hash_pointer(hash, mesh->normals);
    hash = hash_pointer(hash, mesh->uvs);
#if EL_WITH_WIRES
    hash = hash_pointer(hash, mesh->edges);
#endif
    hash = hash_pointer(hash, mesh->clusters);
    hash = hash_pair(hash, mesh->vertex_count, mesh->triangle_count);
    hash = hash_pair(hash, (uint8_t)mesh->scale_log2, mesh->radius);
    hash = hash_pair(hash, (uint16_t)mesh->centre[0], (uint16_t)mesh->centre[1]);
    return el_hash_word(hash, (uint16_t)mesh->centre[2]);
}

#if EL_WITH_MIXED
static uint32_t hash_image(uint32_t hash, const el_image *image)
{
    hash = hash_pointer(hash, image->pixels);
    hash = hash_pointer(hash, image->palette);
    hash = hash_pointer(hash, image->alpha);
    hash = hash_pair(hash, image->width, image->height);
    return hash_pair(hash, (uint32_t)image->format << 1 | image->has_key, image->key);
}

static uint32_t hash_fog(uint32_t hash, const el_fog *fog)
{
    hash = hash_pointer(hash, fog);
    if (fog != NULL) {
        hash = hash_pair(hash, fog->colour, fog->step_log2);
        hash = el_hash_word(el_hash_word(hash, fog->scale_q12), fog->end);
        for (unsigned i = 0; i < EL_FOG_STEPS + 2U; i += 2) {
            hash = hash_pair(hash, fog->alpha_q7[i], fog->alpha_q7[i + 1U]);
        }
    }
    return hash;
}
#endif

static uint32_t hash_one_texture(uint32_t hash, const el_texture *texture)
{
    hash = hash_pointer(hash, texture->texels);
    hash = hash_pair(hash, texture->width_log2, texture->height_log2);
#if EL_WITH_MIXED
    hash = el_hash_word(hash, (uint32_t)texture->wrap_u << 8 | (uint32_t)texture->wrap_v << 1 | texture->smooth);
    if (texture->image != NULL) {
        hash = hash_image(hash, texture->image);
    }
#endif
    return hash;
}

static uint32_t hash_texture(uint32_t hash, const el_texture *texture)
{
    hash = hash_one_texture(hash, texture);
#if EL_WITH_MIPMAPS
    while (texture->smaller != NULL) {
        texture = texture->smaller;
        hash = hash_one_texture(hash, texture);
    }
#endif
    return hash;
}

static uint32_t hash_material(uint32_t hash, const el_material *material)
{
    hash = hash_pair(hash, material->shading, material->flags);
#if EL_WITH_MIXED
    hash = el_hash_word(hash, material->alpha);
    hash = hash_fog(hash, material->fog);
#endif
    hash = el_hash_word(hash, (uint32_t)material->colour[0] << 16 | (uint32_t)material->colour[1] << 8 |
                                  (uint32_t)material->colour[2]);
    hash = hash_pointer(hash, material->texture);
    hash = hash_pointer(hash, material->light);
    if (material->texture != NULL) {
        hash = hash_texture(hash, material->texture);
    }
    if (material->light != NULL) {
        hash = hash_words(hash, material->light->direction_q30, 3);
        hash = hash_pair(hash, material->light->ambient, material->light->diffuse);
    }
    return hash;
}

void el_quiet_look_at(el_renderer *renderer, const el_mesh *mesh, const el_pose *pose, const el_material *material)
{
    uint32_t hash = renderer->quiet.submitted;
    hash = hash_words(hash, pose->rotation_q30[0], 9);
    hash = hash_words(hash, pose->position_q16, 3);
    hash = el_hash_word(hash, pose->scale_q16);
    hash = hash_mesh(hash, mesh);
    renderer->quiet.submitted = hash_material(hash, material);
}

/* --- Sinks -------------------------------------------------------------------------------------------------------- */

/* Of `takers`, those that cannot do without lines [y, y + lines), which are unchanged. */
static uint8_t ask(const el_renderer *renderer, uint8_t takers, int32_t y, int32_t lines)
{
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        const el_sink *const sink = renderer->config.sinks[i];
        if (((unsigned)takers >> i & 1U) != 0 && sink->unchanged != NULL &&
            sink->unchanged(sink->context, (uint16_t)y, (uint16_t)lines)) {
            takers &= (uint8_t) ~(1U << i);
        }
    }
    return takers;
}

/* Whether the layers draw into lines [y, y + lines) what they drew in the frame before. */
static bool layers_repeat(const el_config *config, int32_t y, int32_t lines)
{
    const el_layer *const layers[2] = {config->under, config->over};
    for (unsigned i = 0; i < 2; i++) {
        if (layers[i] != NULL &&
            (layers[i]->unchanged == NULL || !layers[i]->unchanged(layers[i]->context, (uint16_t)y, (uint16_t)lines))) {
            return false;
        }
    }
    return true;
}

bool el_quiet_is_unchanged(el_renderer *renderer)
{
    el_quiet *const quiet = &renderer->quiet;
    quiet->looks = 0;
    if ((quiet->known & EL_REUSE_FRAME) == 0 || quiet->submitted != quiet->was_submitted ||
        !layers_repeat(&renderer->config, 0, renderer->config.height)) {
        return false;
    }
    quiet->takers = ask(renderer, quiet->takers, 0, renderer->config.height);
    quiet->band_takers = quiet->takers;
    if (quiet->takers != 0) {
        return false;
    }
    quiet->drawn = quiet->was_drawn;
    el_count(&renderer->stats.frames_unchanged, 1);
    return true;
}

bool el_quiet_leaves_out(el_renderer *renderer, uint16_t band, bool is_empty)
{
    el_quiet *const quiet = &renderer->quiet;
    const el_config *const config = &renderer->config;
    const uint32_t group = 1U << (band >> quiet->group_log2);
    quiet->band_takers = quiet->takers;
    if (!is_empty) {
        quiet->drawn |= group;
        return false;
    }
    if ((quiet->known & reuse_of(renderer) & EL_REUSE_BACKGROUND) == 0 || (quiet->was_drawn & group) != 0 ||
        quiet->background != config->background) {
        return false;
    }
    const int32_t y = band * config->band_lines;
    const int32_t lines = el_min_i32(config->band_lines, config->height - y);
    if (!layers_repeat(config, y, lines)) {
        return false;
    }
    quiet->band_takers = ask(renderer, quiet->takers, y, lines);
    if (quiet->band_takers != 0) {
        return false;
    }
    el_count(&renderer->stats.lines_background, (uint32_t)lines);
    return true;
}

/* --- Frames ------------------------------------------------------------------------------------------------------- */

void el_quiet_begin(el_renderer *renderer)
{
    el_quiet *const quiet = &renderer->quiet;
    const el_config *const config = &renderer->config;
    quiet->refused = 0;
    quiet->drawn = 0;
    quiet->group_log2 = 0;
    while ((renderer->band_count - 1) >> quiet->group_log2 > 31) {
        quiet->group_log2++;
    }
    quiet->takers = 0;
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        quiet->takers = (uint8_t)(quiet->takers | (config->sinks[i] != NULL ? 1U : 0U) << i);
    }
    quiet->band_takers = quiet->takers;
    quiet->looks = (reuse_of(renderer) & EL_REUSE_FRAME) != 0;
    if (quiet->looks) {
        const uint32_t settings = hash_pair(
            config->background, (uint32_t)el_config_samples(config) << 8 | config->uv_error_log2, config->shading_off);
        quiet->submitted = hash_view(settings, &renderer->view);
    }
}

void el_quiet_end(el_renderer *renderer)
{
    el_quiet *const quiet = &renderer->quiet;
    quiet->known = quiet->refused ? 0 : (uint8_t)reuse_of(renderer);
    quiet->background = renderer->config.background;
    quiet->was_drawn = quiet->drawn;
    quiet->was_submitted = quiet->submitted;
}

#endif
