/* What is drawn: a scene by its name, or meshes from files, drawn one after the other where they lie, with a camera from
 * the command line. */
#ifndef EL_SIM_SUBJECT_H
#define EL_SIM_SUBJECT_H

#include <stdbool.h>
#include <stdint.h>

#include "edgeline.h"
#include "geometry/elm.h"
#include "scene.h"

enum { EL_SUBJECT_MESHES = 65 }; /* places for names of files; one stays free */

/* The command line's wishes; NULL where there is none. `shading` is a mesh's; who plays a scene sees to it himself. */
typedef struct el_subject_options {
    const char *scene;
    const char *meshes[EL_SUBJECT_MESHES];
    unsigned mesh_count;
    const char *eye, *look_at, *fov, *near, *far, *shading;
} el_subject_options;

/* A mesh and the file that holds it. */
typedef struct el_subject_mesh {
    uint8_t *file;
    el_mesh mesh;
    el_elm_surface surface;
    el_material material;
} el_subject_mesh;

typedef struct el_subject {
    const el_scene *scene; /* or: */
    el_subject_mesh meshes[EL_SUBJECT_MESHES];
    unsigned mesh_count; /* of those that are open */
    el_camera camera;
} el_subject;

/* `aspect` is the picture's width over its height. False after one line on stderr. Close it in any case. */
bool el_subject_open(el_subject *subject, const el_subject_options *options, double aspect);
void el_subject_close(el_subject *subject);

uint16_t el_subject_background(const el_subject *subject);

/* Draws a whole frame. */
el_status el_subject_play(const el_subject *subject, uint32_t frame, el_renderer *renderer);

#endif
