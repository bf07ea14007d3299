/* What features are made of: a few meshes, pictures and where they stand.
 *
 * The camera of most of them sees 12 x 8 units where z is 0, from z = 8. */
#ifndef EL_TEST_THINGS_H
#define EL_TEST_THINGS_H

#include "edgeline.h"
#include "scene_units.h"

enum {
    RINGS = 8,
    SEGMENTS = 16,
    ROUND_VERTICES = (RINGS + 1) * (SEGMENTS + 1),
    ROUND_TRIANGLES = RINGS * SEGMENTS * 2
};

/* Around the origin, of radius 1, with vertex colours, normals and texture coordinates. The tube is open, about y from -1 to
 * 1; the cone looks along z, from -1 to its tip at 1, open too. */
extern el_mesh ball, tube, cone;

/* A square from -1 to 1 in x and y, seen from z; with a picture of 16 x 16 texels once, with such a picture and a half of it
 * on each side, and with 128 x 128 texels. */
extern el_mesh card, wide_card, floor_card;

enum { PICTURE_SIDE = 16, ODD_WIDTH = 12, ODD_HEIGHT = 10 };

/* An F, which has no symmetry, in white upon colours: 16 x 16, and 12 x 10 of it. */
extern uint16_t picture[PICTURE_SIDE * PICTURE_SIDE], odd_picture[ODD_WIDTH * ODD_HEIGHT];

/* The same in the other formats; all that shows of the mask is the F. */
extern el_image image_rgb565, image_odd, image_index8, image_index4, image_mask;

/* Alpha from the middle, where it is 255, to the border, where it is 0. */
extern uint8_t glow[PICTURE_SIDE * PICTURE_SIDE];

/* From the upper left; (-2, 3, 2) / sqrt(17). */
extern const el_light white_light;

/* Makes all of the above; again it does nothing. */
void make_things(void);

/* As an el_scene places it. */
void place_camera(uint32_t frame, el_camera *camera);

/* A pose, in tenths of a unit; the scale in tenths, too. */
el_pose at(int32_t x, int32_t y, int32_t z, int32_t scale);

/* Turned about x, and then about its own y. */
el_pose turned(el_pose pose, el_angle about_x, el_angle about_y);

/* Whichever was first. */
static inline el_status worse(el_status a, el_status b)
{
    return a != EL_OK ? a : b;
}

#endif
