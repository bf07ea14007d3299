/* The list of features. */
#include "feature.h"

const feature *const features[] = {
    &feature_shading,
    &feature_lamps,
    &feature_two_sided,
    &feature_clipping,
    &feature_orthographic,
    &feature_aim,
    &feature_keys,
    &feature_hierarchy,
    &feature_instances,
    &feature_billboards,
    &feature_picking,
    &feature_layers,
    &feature_seams,
    &feature_sprites,
#if FEATURES_MIXED
    &feature_fog,
    &feature_formats,
    &feature_wraps,
    &feature_mipmaps,
    &feature_alpha,
    &feature_wires,
#endif
    NULL,
};
