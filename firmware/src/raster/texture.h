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
    return texture->image != NULL ? texture->image->width : 1U << texture->width_log2;
}

static inline uint32_t el_texture_height(const el_texture *texture)
{
    return texture->image != NULL ? texture->image->height : 1U << texture->height_log2;
}

/* Whether it and all its smaller ones can be drawn, with what base/options.h has: formats, sizes, pointers. */
bool el_texture_is_good(const el_texture *texture);

/* Whether it or one of its smaller ones needs more than the loops for texels that repeat. Pre: it is good. */
bool el_texture_is_mixed(const el_texture *texture);

static inline const el_texture *el_texture_at_level(const el_texture *texture, unsigned level)
{
    for (; level > 0; level--) {
        texture = texture->smaller;
    }
    return texture;
}

/* How far down its chain is the texture with which a triangle is drawn (geometry/mesh.h): 2^(2 level + 1) times the area on
 * the screen is the first that exceeds that in texels; or the last. The comparison is exact. */
unsigned el_mip_level(const el_texture *texture, const el_corner corners[3]);

#ifdef __cplusplus
}
#endif

#endif
