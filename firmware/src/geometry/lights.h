/* Many lights: the colours of a mesh's vertices, or of its triangles, in the light of any number of lamps.
 *
 * What is computed goes into an array of the caller's, 3 bytes for each vertex or triangle, and is drawn as any colours are:
 *
 *     el_light_vertices(&lighting, &mesh, &pose, camera.position_q16, colours);
 *     el_mesh lit = mesh;
 *     lit.colours = colours;                         (from el_light_triangles: lit.triangle_colours, drawn flat)
 *     el_draw(&r, &lit, &pose, &material);           Gouraud, textured times Gouraud, blended, in fog: without a light
 *
 * So each vertex is lit once per frame and not once per triangle, band and pass; and not at all while nothing of it moves. One
 * directional lamp, all white, needs no array: el_material.light. */
#ifndef EL_GEOMETRY_LIGHTS_H
#define EL_GEOMETRY_LIGHTS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"
#include "geometry/mesh.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_LAMPS_MAX = 32 };

typedef enum el_lamp_kind {
    EL_LAMP_DIRECTIONAL, /* from far away */
    EL_LAMP_POINT,       /* from a place in all directions */
    EL_LAMP_SPOT         /* from a place within a cone */
} el_lamp_kind;

/* World space. Directions have length 1. */
typedef struct el_lamp {
    uint8_t kind;             /* el_lamp_kind */
    uint8_t colour[3];        /* red, green, blue: 255 shows a surface that faces it in its own colour */
    int32_t direction_q30[3]; /* directional: towards the lamp; spot: where it looks, away from it */
    int32_t position_q16[3];  /* point and spot */
    uint32_t half_q16;        /* point and spot: 1 / (1 + (distance / half)^2) of the light arrives, a half at that
                                 distance; 0: all of it at any */
    /* Spot: all of it within the angle of cosine `inner`, none beyond that of `outer`, which is less; 3 t^2 - 2 t^3 of it
     * between, t linear in the cosine. */
    int32_t inner_q30, outer_q30;
} el_lamp;

/* How a highlight falls off: c^exponent, as a table over (1 - c) * exponent, along which all exponents look nearly alike:
 * e^-10 and less is nothing. Linear between entries, within 1/4000 of all. The caller's memory, for any number of lightings. */
enum { EL_HIGHLIGHT_STEP_LOG2 = -5, EL_HIGHLIGHT_STEPS = 10 * 32, EL_HIGHLIGHT_EXPONENT_MAX = 1024 };

typedef struct el_highlight {
    uint16_t exponent;
    uint16_t power_q15[EL_HIGHLIGHT_STEPS + 1];
} el_highlight;

/* `exponent` 1, a broad shine, to EL_HIGHLIGHT_EXPONENT_MAX, a mirror's. EL_ERROR_RANGE: any other. */
el_status el_highlight_make(el_highlight *highlight, uint32_t exponent);

/* Lamps, and how a surface takes them. Its own colours are the mesh's, or `colour` where that has none. Each channel is
 *
 *     emissive + colour * (ambient + sum of lamp * max(0, n.l)) + specular * sum of lamp * max(0, n.h)^exponent
 *
 * with 255 for 1, at most 255: n the normal, l towards the lamp, h halfway between l and the direction towards the eye
 * (Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977); lamps behind the surface have no
 * part in either sum. */
typedef struct el_lighting {
    const el_lamp *lamps;
    const el_highlight *highlight; /* NULL: none, whatever is specular */
    uint8_t lamp_count;            /* 0 to EL_LAMPS_MAX */
    uint8_t ambient[3], emissive[3], specular[3];
    uint8_t colour[3];
    bool two_sided; /* normals that look away from the eye are turned around */
} el_lighting;

/* The colours [vertex_count], within 1/255 of the formula. `colours` may be the mesh's own only if those are not const data.
 * EL_ERROR_ARGUMENT: a NULL. EL_ERROR_MATERIAL: a mesh without normals, a lamp of no kind, a spot whose cosines are the
 * wrong way round, a highlight that nobody has made. EL_ERROR_SIZE: too many lamps. Nothing is written then. */
el_status el_light_vertices(const el_lighting *lighting, const el_mesh *mesh, const el_pose *pose,
                            const int32_t eye_q16[3], uint8_t (*colours)[3]);

/* The same for triangles [triangle_count]: at the mean of their corners, with the mean of their normals. Their own colours
 * are the mesh's triangle_colours, or those of their first vertices. */
el_status el_light_triangles(const el_lighting *lighting, const el_mesh *mesh, const el_pose *pose,
                             const int32_t eye_q16[3], uint8_t (*colours)[3]);

#ifdef __cplusplus
}
#endif

#endif
