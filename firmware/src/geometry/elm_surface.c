/* Material and picture of an .elm: the head says what there is, the rest is palette, texels and alpha as base/image.h has
 * them in memory. What is found here is good for el_draw: formats, sizes and keys are checked, so nothing is refused later. */
#include "geometry/elm_surface.h"

#if EL_WITH_MIXED

#include <string.h>

enum {
    FLAGS_AT = 0,
    ALPHA_AT = 1,
    FORMAT_AT = 2,
    LEVELS_AT = 3,
    WRAP_AT = 4, /* u, v */
    BITS_AT = 6,
    KEY_AT = 8,
    BIT_SMOOTH = 1,
    BIT_KEY = 2,
    BIT_ALPHA = 4,
    BITS_ALL = 7,
    FLAG_TWO_SIDED = 1
};

static uint32_t padded(uint32_t bytes)
{
    return (bytes + 3u) & ~3u;
}

static uint32_t u16_at(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8;
}

static uint32_t palette_bytes(unsigned format)
{
    static const uint16_t bytes[] = {0, 512, 32, 2};
    return bytes[format];
}

/* A row of the format, 1..1024 texels. */
static uint32_t row_bytes(unsigned format, uint32_t width)
{
    static const uint8_t bits[] = {16, 8, 4, 1};
    return (width * bits[format] + 7) / 8;
}

static uint32_t side_at(unsigned side_log2, unsigned level)
{
    return level < side_log2 ? 1u << (side_log2 - level) : 1;
}

static bool has_alpha(const uint8_t *section)
{
    return (section[BITS_AT] & BIT_ALPHA) != 0;
}

static bool is_zero(const uint8_t *bytes, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++) {
        if (bytes[i] != 0) {
            return false;
        }
    }
    return true;
}

static bool is_consistent(const uint8_t *section, unsigned width_log2, unsigned height_log2)
{
    static const uint32_t keys[] = {65536, 256, 16, 2};
    const unsigned levels = section[LEVELS_AT];
    const unsigned format = section[FORMAT_AT];
    const uint32_t key = u16_at(section + KEY_AT);
    if (section[FLAGS_AT] > FLAG_TWO_SIDED || section[ALPHA_AT] == 0 || section[BITS_AT + 1] != 0 ||
        u16_at(section + KEY_AT + 2) != 0) {
        return false;
    }
    if (levels == 0) {
        return format == 0 && is_zero(section, WRAP_AT, EL_ELM_SURFACE_HEAD) && (width_log2 | height_log2) == 0;
    }
    const unsigned longest = width_log2 > height_log2 ? width_log2 : height_log2;
    return levels <= longest + 1 && format <= EL_IMAGE_MASK && section[WRAP_AT] <= EL_WRAP_MIRROR &&
           section[WRAP_AT + 1] <= EL_WRAP_MIRROR && section[BITS_AT] <= BITS_ALL &&
           ((section[BITS_AT] & BIT_KEY) != 0 ? key < keys[format] : key == 0);
}

uint32_t el_elm_surface_bytes(const uint8_t *section, unsigned width_log2, unsigned height_log2)
{
    if (!is_consistent(section, width_log2, height_log2)) {
        return 0;
    }
    const unsigned format = section[FORMAT_AT];
    uint32_t bytes = EL_ELM_SURFACE_HEAD;
    if (section[LEVELS_AT] != 0) {
        bytes += padded(palette_bytes(format));
    }
    /* A level has at most 2^20 texels of three bytes, and all of them less than twice that: below 2^23. */
    for (unsigned level = 0; level < section[LEVELS_AT]; level++) {
        const uint32_t width = side_at(width_log2, level);
        const uint32_t height = side_at(height_log2, level);
        bytes += padded(height * row_bytes(format, width)) + (has_alpha(section) ? padded(height * width) : 0);
    }
    return bytes;
}

/* The `bytes` at *at, which moves on behind their padding; NULL when that is not 0. */
static const uint8_t *take(const uint8_t *section, uint32_t *at, uint32_t bytes)
{
    const uint32_t begin = *at;
    *at = begin + padded(bytes);
    return is_zero(section, begin + bytes, *at) ? section + begin : NULL;
}

bool el_elm_surface_open(const uint8_t *section, unsigned width_log2, unsigned height_log2, el_elm_surface *surface)
{
    const unsigned format = section[FORMAT_AT];
    const unsigned bits = section[BITS_AT];
    const bool is_image = format != EL_IMAGE_RGB565 || (bits & (BIT_KEY | BIT_ALPHA)) != 0;
    el_elm_surface found = {.flags = section[FLAGS_AT], .alpha = section[ALPHA_AT]};
    uint32_t at = EL_ELM_SURFACE_HEAD;
    const uint8_t *const palette = section[LEVELS_AT] != 0 ? take(section, &at, palette_bytes(format)) : section;
    bool is_good = palette != NULL;
    for (unsigned level = 0; level < section[LEVELS_AT]; level++) {
        const uint32_t width = side_at(width_log2, level);
        const uint32_t height = side_at(height_log2, level);
        const uint8_t *const texels = take(section, &at, height * row_bytes(format, width));
        const uint8_t *const alpha = has_alpha(section) ? take(section, &at, height * width) : NULL;
        is_good = is_good && texels != NULL && (alpha != NULL || !has_alpha(section));
        if (level >= EL_ELM_LEVELS) {
            continue; /* what this renderer has no use for is checked all the same */
        }
        /* Sections and their parts begin at multiples of 4. */
        found.images[level] = (el_image){.width = (uint16_t)width,
                                         .height = (uint16_t)height,
                                         .format = (uint8_t)format,
                                         .has_key = (bits & BIT_KEY) != 0,
                                         .key = (uint16_t)u16_at(section + KEY_AT),
                                         .pixels = texels,
                                         .palette = (const uint16_t *)(const void *)palette,
                                         .alpha = alpha};
        found.levels[level] = (el_texture){.texels = is_image ? NULL : (const uint16_t *)(const void *)texels,
                                           .width_log2 = (uint8_t)(width_log2 > level ? width_log2 - level : 0),
                                           .height_log2 = (uint8_t)(height_log2 > level ? height_log2 - level : 0),
                                           .wrap_u = section[WRAP_AT],
                                           .wrap_v = section[WRAP_AT + 1],
                                           .smooth = (bits & BIT_SMOOTH) != 0,
                                           .image = is_image ? &surface->images[level] : NULL};
#if EL_WITH_MIPMAPS
        if (level > 0) {
            found.levels[level - 1].smaller = &surface->levels[level];
        }
#endif
    }
    if (is_good) {
        *surface = found;
    }
    return is_good;
}

#endif
