#include "raster/texture.h"

#include "base/fixed.h"

#if EL_WITH_MIXED || EL_WITH_MIPMAPS

#if EL_WITH_MIXED
/* Rows begin with a byte, and so do values of 16 bits with an even address, which the caller sees to. */
static bool image_is_good(const el_image *image)
{
    return image->width >= 1 && image->width <= EL_TEXTURE_MAX_SIDE && image->height >= 1 &&
           image->height <= EL_TEXTURE_MAX_SIDE && image->format <= EL_IMAGE_MASK && image->pixels != NULL &&
           (image->format == EL_IMAGE_RGB565 || image->palette != NULL);
}

static bool is_good_alone(const el_texture *texture)
{
    const bool has_texels = texture->image != NULL ? image_is_good(texture->image) : el_texture_has_texels(texture);
    return has_texels && texture->wrap_u <= EL_WRAP_MIRROR && texture->wrap_v <= EL_WRAP_MIRROR;
}
#else
static bool is_good_alone(const el_texture *texture)
{
    return el_texture_has_texels(texture);
}
#endif

#if EL_WITH_MIPMAPS
static bool is_half(uint32_t smaller, uint32_t size)
{
    return 2U * smaller == size || (smaller == 1 && size == 1);
}
#endif

bool el_texture_is_good(const el_texture *texture)
{
    if (!is_good_alone(texture)) {
        return false;
    }
#if EL_WITH_MIPMAPS
    for (const el_texture *next = texture->smaller; next != NULL; next = texture->smaller) {
        const uint32_t width = el_texture_width(texture);
        const uint32_t height = el_texture_height(texture);
        /* Of one texel there is no smaller one: no chain goes on for ever. */
        if (width * height == 1 || !is_good_alone(next) || !is_half(el_texture_width(next), width) ||
            !is_half(el_texture_height(next), height)) {
            return false;
        }
        texture = next;
    }
#endif
    return true;
}

bool el_texture_is_mixed(const el_texture *texture)
{
#if EL_WITH_MIPMAPS
    for (; texture->smaller != NULL && el_texture_is_plain(texture); texture = texture->smaller) {
    }
#endif
    return !el_texture_is_plain(texture);
}

#if EL_WITH_MIPMAPS
unsigned el_mip_level(const el_texture *texture, const el_corner corners[3])
{
    const int32_t x[3] = {corners[0].x, corners[1].x, corners[2].x};
    const int32_t y[3] = {corners[0].y, corners[1].y, corners[2].y};
    const uint64_t on_screen = el_abs_u64(el_doubled_area(x, y));
    /* |u|, |v| < 2^27 in Q16: differences below 2^28, products below 2^56. */
    const int64_t du1 = corners[1].u_q16 - corners[0].u_q16;
    const int64_t dv1 = corners[1].v_q16 - corners[0].v_q16;
    const int64_t du2 = corners[2].u_q16 - corners[0].u_q16;
    const int64_t dv2 = corners[2].v_q16 - corners[0].v_q16;
    const uint64_t in_texels_q32 = el_abs_u64(du1 * dv2 - du2 * dv1);
    /* t < s 2^n and floor(t / 2^n) < s are the same for whole numbers. */
    unsigned level = 0;
    unsigned shift = 32 - 2 * EL_SUBPIXEL_BITS + 1;
    while (texture->smaller != NULL && in_texels_q32 >> shift >= on_screen) {
        texture = texture->smaller;
        level++;
        shift += 2;
    }
    return level;
}
#endif
#endif
