/* What the stages ask of a texture before its texels. Private to the renderer. */
#ifndef EL_RASTER_TEXTURE_H
#define EL_RASTER_TEXTURE_H

#include <stdbool.h>

#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Its size in texels. */
static inline uint32_t el_texture_width(const el_texture *texture)
{
#if EL_WITH_MIXED
    if (texture->image != NULL) {
        return texture->image->width;
    }
#endif
    return 1U << texture->width_log2;
}

static inline uint32_t el_texture_height(const el_texture *texture)
{
#if EL_WITH_MIXED
    if (texture->image != NULL) {
        return texture->image->height;
    }
#endif
    return 1U << texture->height_log2;
}

/* Whether the loops for texels that repeat draw it. */
static inline bool el_texture_is_plain(const el_texture *texture)
{
#if EL_WITH_MIXED
    return texture->image == NULL && (texture->wrap_u | texture->wrap_v | (uint8_t)texture->smooth) == 0;
#else
    (void)texture;
    return true;
#endif
}

/* Whether it has texels, if it is plain. */
static inline bool el_texture_has_texels(const el_texture *texture)
{
    return texture->texels != NULL && texture->width_log2 <= 10 && texture->height_log2 <= 10;
}

/* Whether it and all its smaller ones can be drawn, with what base/options.h has: formats, sizes, pointers. */
#if EL_WITH_MIXED || EL_WITH_MIPMAPS
bool el_texture_is_good(const el_texture *texture);
#else
static inline bool el_texture_is_good(const el_texture *texture)
{
    return el_texture_has_texels(texture);
}
#endif

/* Whether it or one of its smaller ones needs el_fill_mixed. Pre: it is good. */
bool el_texture_is_mixed(const el_texture *texture);

static inline const el_texture *el_texture_at_level(const el_texture *texture, unsigned level)
{
#if EL_WITH_MIPMAPS
    for (; level > 0; level--) {
        texture = texture->smaller;
    }
#else
    (void)level;
#endif
    return texture;
}

/* How far down its chain is the texture with which a triangle is drawn (geometry/mesh.h): 2^(2 level + 1) times the area on
 * the screen is the first that exceeds that in texels; or the last. The comparison is exact. */
unsigned el_mip_level(const el_texture *texture, const el_corner corners[3]);

#ifdef __cplusplus
}
#endif

#endif
