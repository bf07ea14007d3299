/* Features: small pictures, each of one thing that the library can do in all its kinds, side by side.
 *
 * They are what tests/golden has as feature-NAME.png, what is drawn in all bands, arenas, samples and cores, and what every
 * core must draw to the last bit. Plain C without files or arguments: the same sources run on a bare core. */
#ifndef EL_TEST_FEATURE_H
#define EL_TEST_FEATURE_H

#include "edgeline.h"
#include "scene.h"

enum { FEATURE_WIDTH = 240, FEATURE_HEIGHT = 160, FEATURE_PIXELS = FEATURE_WIDTH * FEATURE_HEIGHT };

typedef struct feature {
    el_scene scene; /* of one frame, number 0 */
    el_layer under, over;
    bool blends_depth; /* which a depth pre-pass refuses (EL_MATERIAL_BLEND_DEPTH) */
    bool has_wires;    /* which several samples refuse (EL_MATERIAL_WIRES) */
} feature;

/* Ends with a NULL. */
extern const feature *const features[];

extern const feature feature_shading, feature_lamps, feature_two_sided, feature_fog, feature_formats, feature_wraps,
    feature_mipmaps, feature_alpha, feature_clipping, feature_orthographic, feature_aim, feature_keys,
    feature_hierarchy, feature_instances, feature_billboards, feature_picking, feature_layers, feature_seams,
    feature_sprites, feature_wires;

/* What small code leaves out (base/options.h). */
#define FEATURES_MIXED (EL_WITH_MIXED && EL_WITH_MIPMAPS && EL_WITH_WIRES)

#endif
