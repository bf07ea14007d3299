/* How surfaces look: shading, light and draw state. */
#ifndef EL_RASTER_MATERIAL_H
#define EL_RASTER_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/options.h"
#include "geometry/mesh.h"

/* Bit 0: vertex colours; bit 1: a texture. base/options.h can leave each of them out but the first. */
typedef enum el_shading {
    EL_SHADE_FLAT = 0,             /* one colour per triangle */
    EL_SHADE_GOURAUD = 1,          /* vertex colours, linear on the screen */
    EL_SHADE_TEXTURED = 2,         /* texels, perspective-correct */
    EL_SHADE_TEXTURED_GOURAUD = 3, /* texels times vertex colours */
    EL_SHADE_OVERDRAW = 4          /* each pixel drawn adds 1 to what is there: counts, not colours */
} el_shading;

static inline bool el_has_colours(el_shading shading)
{
    return EL_WITH_GOURAUD && (shading & 1U) != 0;
}

static inline bool el_has_texture(el_shading shading)
{
    return EL_WITH_TEXTURE && (shading & 2U) != 0;
}

enum {
    EL_MATERIAL_TWO_SIDED = 1, /* draws back faces too; their normals are turned around */
    EL_MATERIAL_NO_DEPTH = 2,  /* neither tests nor writes depth: what is drawn later covers what was earlier */
    EL_MATERIAL_FLAT_MEAN = 4, /* flat: the mean of the three vertices' colours instead of the first vertex' */
    EL_MATERIAL_DITHER = 8,    /* vertex colours and light: 4x4 ordered dithering to the display's levels (dither.h) */
#if EL_WITH_WIRES
    EL_MATERIAL_WIRES = 32, /* draws edges, below, in place of what is within */
#endif
    EL_MATERIAL_BLEND_DEPTH = 16 /* what is blended writes depth, too; not with el_config.depth_prepass */
};

/* Ambient light and one directional light, both white. */
typedef struct el_light {
    int32_t direction_q30[3]; /* towards the light, world space, length 1 */
    uint8_t ambient;          /* 255 shows a surface in its own colour */
    uint8_t diffuse;          /* added where the surface faces the light, less by the cosine elsewhere */
} el_light;

/* Zeroed: flat, black, front faces, with depth, opaque. What it points to must stay until the frame is done.
 *
 * What is blended (alpha of 1 to 254, or a texture's image with alpha) is mixed with what is drawn already: a weight of
 * el_alpha_256(alpha) / 256, times the texel's, rounded to nearest; el_rgb565_blend mixes. It is tested by depth, and leaves
 * depth as it is. So draw opaque things first, and then what is blended from the back to the front: within a mesh its
 * triangles are drawn in their order, and meshes in the order of submission, whatever bands, passes and arenas there are.
 *
 * Wires (EL_MATERIAL_WIRES) are the edges of those triangles that would be drawn, or those of them that el_mesh.edges names:
 * lines of one pixel (wires.h), flat and opaque, in the material's colour whatever colours and light there are. Draw them
 * after the surface that they belong to: they are tested as if they were a little nearer, as much as that surface may change
 * its depth over half a pixel. A surface that is blended with an alpha of 1 and EL_MATERIAL_BLEND_DEPTH hides what is behind
 * it and leaves colours as they are: lines over anything, without hidden ones. With EL_MATERIAL_NO_DEPTH all are seen. */
typedef struct el_material {
    uint8_t shading;   /* el_shading */
    uint8_t flags;     /* EL_MATERIAL_ */
    uint8_t colour[3]; /* red, green, blue of meshes without colours of their own */
#if EL_WITH_MIXED
    uint8_t alpha; /* 0 and 255: opaque */
#endif
    const el_texture *texture; /* for the textured shadings */
    const el_light *light;     /* NULL: colours as they are. Needs a mesh with normals. Not for EL_SHADE_TEXTURED, whose
                                  texels are as they are: EL_SHADE_TEXTURED_GOURAUD is texels in a light */
#if EL_WITH_MIXED
    const struct el_fog *fog; /* NULL: none. Of what is drawn with depth, for a perspective camera (fog.h) */
#endif
} el_material;

/* What a surface needs beside its shading. */
enum {
    EL_FINISH_DITHER = EL_WITH_GOURAUD && EL_WITH_DITHER ? 16 : 0, /* Gouraud and textured times Gouraud alone */
    EL_FINISH_MIXED = EL_WITH_MIXED ? 32 : 0,                      /* el_fill_mixed; not with overdraw */
    EL_FINISH_WIRES = EL_WITH_WIRES ? 64 : 0                       /* el_wires_draw; flat alone */
};

static inline bool el_is_lit(const el_material *material)
{
    return EL_WITH_LIGHT && material->light != NULL;
}

#if EL_WITH_MIXED
/* Whether what is drawn is mixed with what is there. */
static inline bool el_is_blended(const el_material *material)
{
    if ((uint8_t)(material->alpha + 1U) > 1U) {
        return true;
    }
    return el_has_texture((el_shading)material->shading) && material->texture->image != NULL &&
           material->texture->image->alpha != NULL;
}
#endif

#endif
