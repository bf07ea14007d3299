/* The debug views. What a view counts lies in the colour band while it is drawn, in place of colours: no view needs memory
 * of its own. When the band is complete its counts, or its depth, become colours. */
#include "frame/debug_view.h"

#include "base/fixed.h"
#include "base/rgb565.h"
#include "frame/debug_hooks.h"
#include "raster/sampler.h"

#if EL_WITH_DEBUG_VIEWS

/* Lightness 0, 20, 28, .. 100, hue from 285 to 470 degrees, the chroma that RGB allows up to 90, in CIE L*a*b*: made and
 * compared by tests/accuracy/test_debug_views.py. */
const uint16_t el_debug_heat[EL_DEBUG_HEATS] = {0x0000, 0x018C, 0x2957, 0x9015, 0xC012, 0xE810,
                                                0xFA8D, 0xFC0D, 0xFD2E, 0xFE30, 0xFF34, 0xFFFF};

enum {
    BAR_WORK = 6,       /* per pixel of a band: as long as the band */
    HEATS_PER_WORK = 2, /* BAR_WORK * HEATS_PER_WORK is a heat beyond the last */
    NEAR_GREY = 255,
    GREYS = 255 - 32 /* from near to far */
};
_Static_assert(BAR_WORK *HEATS_PER_WORK == EL_DEBUG_HEATS, "the longest bar has the last heat");

/* In units of a flat pixel with depth; modulo 2^32, which a band does not reach. */
static uint32_t work_of(const el_stats *stats)
{
    return stats->setups * EL_DEBUG_SETUP_WORK + stats->rows * EL_DEBUG_ROW_WORK + stats->pixels;
}

static bool counts(unsigned view)
{
    return view == EL_DEBUG_OVERDRAW || view == EL_DEBUG_REJECTED;
}

bool el_debug_begin_draw(const el_renderer *renderer, el_draw_state *draw, el_shading *shading)
{
    const el_material *const material = draw->material;
    const unsigned view = renderer->config.view;
    unsigned in_force = material->shading & ~(unsigned)renderer->config.shading_off;
    if (counts(view)) {
        in_force = EL_SHADE_OVERDRAW;
    } else if (view == EL_DEBUG_DEPTH || view == EL_DEBUG_TRIANGLES) {
        in_force = EL_SHADE_FLAT;
    }
    *shading = (el_shading)in_force;
    draw->reshading = (in_force ^ material->shading) & 7U;
    draw->number = (renderer->stats.draws - renderer->pass_draws) & 31U;
    /* What is drawn without depth has none to show, and is never found hidden. */
    const bool has_depth = (material->flags & EL_MATERIAL_NO_DEPTH) == 0 && material->shading != EL_SHADE_OVERDRAW;
    return has_depth || (view != EL_DEBUG_DEPTH && view != EL_DEBUG_REJECTED);
}

uint16_t el_debug_begin_band(const el_renderer *renderer, el_painter *painter)
{
    const unsigned view = renderer->config.view;
    painter->band_work = work_of(painter->stats);
    return counts(view) || view == EL_DEBUG_DEPTH ? 0 : renderer->config.background;
}

/* A colour of no dark channel for each triangle, unlike its neighbours'. */
static uint16_t triangle_colour(uint32_t draw, uint32_t triangle)
{
    /* The mixing steps of MurmurHash3's end (Appleby, public domain). */
    uint32_t hash = triangle << 5 | draw;
    hash = (hash ^ hash >> 16) * 0x85EBCA6BU;
    hash = (hash ^ hash >> 13) * 0xC2B2AE35U;
    return (uint16_t)(hash >> 16 | 0x4208U); /* 8 of 31, 16 of 63 and 8 of 31 at least */
}

/* The texel in the triangle's middle. */
static uint16_t middle_texel(const el_draw_state *draw, uint16_t index)
{
    const el_texture *const texture = draw->material->texture;
    const uint16_t *const vertices = draw->mesh->triangles[index];
    uint32_t whole[2];
    for (unsigned i = 0; i < 2; i++) {
        int32_t sum_q4 = 0; /* 12.4 as the mesh has them */
        for (unsigned corner = 0; corner < 3; corner++) {
            sum_q4 += draw->mesh->uvs[vertices[corner]][i];
        }
        whole[i] = (uint32_t)(sum_q4 / 3 >> 4);
    }
    el_sampler sampler;
    el_sampler_make(&sampler, texture);
    uint16_t colour = 0;
    (void)el_sampler_at(&sampler, whole[0] << 16, whole[1] << 16, &colour);
    return colour;
}

void el_debug_surface(const el_renderer *renderer, const el_record *record, el_surface *surface)
{
    const el_draw_state *const draw = el_list_draw(&renderer->list, record);
    if (renderer->config.view == EL_DEBUG_TRIANGLES) {
        surface->colour = triangle_colour(draw->number, record->index);
    } else if (surface->shading == EL_SHADE_FLAT && draw->material->shading == EL_SHADE_TEXTURED) {
        surface->colour = middle_texel(draw, record->index);
    }
    /* A counting loop with depth counts what is hidden. */
    surface->depth = surface->depth || renderer->config.view == EL_DEBUG_REJECTED;
}

static void show_counts(const el_band *band)
{
    const uint32_t pixels = (uint32_t)band->width * band->lines;
    for (uint32_t i = 0; i < pixels; i++) {
        const uint32_t count = band->pixels[i];
        band->pixels[i] = el_debug_heat[count < EL_DEBUG_HEATS ? count : EL_DEBUG_HEATS - 1U];
    }
}

/* log2 x in 1/256, linear between powers of two (0.09 too low at most); of 0 as of 1. */
static uint32_t log2_q8(uint32_t x)
{
    const uint32_t whole = (uint32_t)el_bit_length_u32(x | 1U) - 1U;
    return whole << 8 | ((x << (31U - whole)) >> 23 & 255U);
}

/* In perspective, depth = scale * (1 - near / distance), so scale - depth goes with 1 / distance. */
static void show_depth(const el_view *view, const el_band *band)
{
    const uint32_t scale_q12 = view->depth_scale_q12;
    const bool is_orthographic = view->projection == EL_ORTHOGRAPHIC;
    const uint32_t nearest_q8 = log2_q8(scale_q12);
    /* far >= 9/8 near makes the range 32 at least; the factor times the range is GREYS. */
    const uint32_t range_q8 = nearest_q8 - log2_q8(scale_q12 - ((uint32_t)EL_DEPTH_MAX << 12));
    const uint32_t factor_q16 = ((uint32_t)GREYS << 16) / range_q8;
    const uint32_t pixels = (uint32_t)band->width * band->lines;
    for (uint32_t i = 0; i < pixels; i++) {
        const uint32_t depth = band->depth[i];
        if (depth > EL_DEPTH_MAX) {
            continue;
        }
        const uint32_t rest_q12 = scale_q12 - (depth << 12); /* scale >= EL_DEPTH_MAX: far / (far - near) > 1 */
        const uint32_t darker_q16 =
            is_orthographic ? depth * (uint32_t)GREYS : (nearest_q8 - log2_q8(rest_q12)) * factor_q16;
        const uint8_t grey = (uint8_t)(NEAR_GREY - (darker_q16 >> 16));
        band->pixels[i] = el_rgb565(grey, grey, grey);
    }
}

static void show_work(uint32_t work, const el_band *band)
{
    const uint32_t pixels = (uint32_t)band->width * band->lines;
    const uint32_t most = pixels * BAR_WORK; /* below 2^24 */
    const uint32_t shown = work < most ? work : most;
    const uint32_t end = shown / ((uint32_t)band->lines * BAR_WORK);
    const uint32_t heat = shown * HEATS_PER_WORK / pixels;
    const uint16_t colour = el_debug_heat[heat < EL_DEBUG_HEATS ? heat : EL_DEBUG_HEATS - 1U];
    uint16_t *pixel = band->pixels;
    for (uint32_t y = 0; y < band->lines; y++) {
        for (uint32_t x = 0; x < band->width; x++, pixel++) {
            const uint32_t dark = *pixel >> 2 & 0x39E7U;               /* a quarter of each channel */
            const uint32_t bar = x < end ? colour >> 1 & 0x7BEFU : 0U; /* a half; together no channel runs over */
            *pixel = (uint16_t)(dark + bar);
        }
    }
}

void el_debug_finish_band(const el_renderer *renderer, const el_painter *painter)
{
    const el_band *const band = &painter->bands[painter->current];
    switch (renderer->config.view) {
    case EL_DEBUG_OVERDRAW:
    case EL_DEBUG_REJECTED:
        show_counts(band);
        break;
    case EL_DEBUG_DEPTH:
        show_depth(&renderer->view, band);
        break;
    case EL_DEBUG_BANDS:
        show_work(work_of(painter->stats) - painter->band_work, band);
        break;
    default:
        break;
    }
}

#endif
