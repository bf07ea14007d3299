/* The standard benchmark scenes S1 to S4, on which Edgeline and its peers are measured. All share one camera: focal
 * length 160 px at 320x240, the principal point in the middle. */
#ifndef EL_APPS_BENCH_SCENES_H
#define EL_APPS_BENCH_SCENES_H

#include "scene.h"

extern const el_scene el_bench_scenes[];
extern const size_t el_bench_scene_count;

#endif
