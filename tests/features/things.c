#include "things.h"

enum { SCALE_LOG2 = -12, ONE = 1 << 12 };

el_mesh ball, tube, cone, card, wide_card, floor_card;
uint16_t picture[PICTURE_SIDE * PICTURE_SIDE], odd_picture[ODD_WIDTH * ODD_HEIGHT];
el_image image_rgb565, image_odd, image_index8, image_index4, image_mask;
uint8_t glow[PICTURE_SIDE * PICTURE_SIDE];
const el_light white_light = {.direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 80, .diffuse = 190};

/* --- Round things --------------------------------------------------------------------------------------------------------- */

typedef struct round_arrays {
    int16_t positions[ROUND_VERTICES][3];
    int8_t normals[ROUND_VERTICES][3];
    uint8_t colours[ROUND_VERTICES][3];
    int16_t uvs[ROUND_VERTICES][2];
} round_arrays;

/* A ring about y: Q30. */
typedef struct ring {
    int32_t radius, height;
    int32_t outward, upward; /* of its normals */
} ring;

static ring ball_ring(unsigned number)
{
    const el_angle angle = number * (0x80000000U / RINGS);
    const ring r = {el_sin_q30(angle), el_cos_q30(angle), el_sin_q30(angle), el_cos_q30(angle)};
    return r;
}

static ring tube_ring(unsigned number)
{
    const ring r = {EL_UNIT_Q30, EL_UNIT_Q30 - (int32_t)number * (EL_UNIT_Q30 / (RINGS / 2)), EL_UNIT_Q30, 0};
    return r;
}

/* Its normals are (2, 1) / sqrt(5). */
static ring cone_ring(unsigned number)
{
    ring r = tube_ring(number);
    r.radius = (int32_t)number * (EL_UNIT_Q30 / RINGS);
    r.outward = 960383883;
    r.upward = 480191942;
    return r;
}

static int32_t product_q30(int32_t a, int32_t b)
{
    return (int32_t)((int64_t)a * b >> 30);
}

static void make_ring(round_arrays *to, unsigned number, ring r, bool looks_along_z)
{
    for (unsigned k = 0; k <= SEGMENTS; k++) {
        const unsigned i = number * (SEGMENTS + 1) + k;
        const el_angle angle = k * (0xFFFFFFFFU / SEGMENTS + 1U);
        const int32_t sine = el_sin_q30(angle);
        const int32_t cosine = el_cos_q30(angle);
        const int32_t place[3] = {product_q30(r.radius, sine), r.height, product_q30(r.radius, cosine)};
        const int32_t normal[3] = {product_q30(r.outward, sine), r.upward, product_q30(r.outward, cosine)};
        for (unsigned c = 0; c < 3; c++) {
            /* About x by a quarter turn: y becomes z, and z becomes -y. */
            const unsigned from = looks_along_z ? (3 - c) % 3 : c;
            const int32_t sign = looks_along_z && c == 1 ? -1 : 1;
            to->positions[i][c] = (int16_t)(sign * (place[from] >> 18));
            to->normals[i][c] = (int8_t)(sign * product_q30(normal[from], 127));
            to->colours[i][c] = (uint8_t)(128 + product_q30(place[c], 127));
        }
        to->uvs[i][0] = (int16_t)(k * 4 * 16);
        to->uvs[i][1] = (int16_t)(number * 4 * 16);
    }
}

/* Counter-clockwise from outside: rings go down, segments to the right. */
static const uint16_t (*triangles_between_rings(void))[3]
{
    static uint16_t triangles[ROUND_TRIANGLES][3];
    for (unsigned i = 0; i < RINGS * SEGMENTS; i++) {
        const uint16_t corner = (uint16_t)(i / SEGMENTS * (SEGMENTS + 1) + i % SEGMENTS);
        const uint16_t corners[4] = {corner, (uint16_t)(corner + SEGMENTS + 1), (uint16_t)(corner + SEGMENTS + 2),
                                     (uint16_t)(corner + 1)};
        for (unsigned k = 0; k < 3; k++) {
            triangles[2 * i][k] = corners[k];
            triangles[2 * i + 1][k] = corners[k == 0 ? 0 : k + 1];
        }
    }
    return (const uint16_t(*)[3])triangles;
}

static el_mesh make_round(round_arrays *to, ring ring_at(unsigned), bool looks_along_z)
{
    for (unsigned i = 0; i <= RINGS; i++) {
        make_ring(to, i, ring_at(i), looks_along_z);
    }
    return (el_mesh){.positions = (const int16_t(*)[3])to->positions,
                     .triangles = triangles_between_rings(),
                     .colours = (const uint8_t(*)[3])to->colours,
                     .normals = (const int8_t(*)[3])to->normals,
                     .uvs = (const int16_t(*)[2])to->uvs,
                     .vertex_count = ROUND_VERTICES,
                     .triangle_count = ROUND_TRIANGLES,
                     .scale_log2 = SCALE_LOG2,
                     .radius = 5800};
}

/* --- Cards ------------------------------------------------------------------------------------------------------------------ */

/* Texels [least, most) from left to right and from top to bottom. */
static el_mesh make_card(int16_t uvs[4][2], int least, int most)
{
    static const int16_t positions[4][3] = {{-ONE, -ONE, 0}, {ONE, -ONE, 0}, {ONE, ONE, 0}, {-ONE, ONE, 0}};
    static const uint16_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static const uint8_t colours[4][3] = {{255, 60, 60}, {60, 255, 60}, {80, 80, 255}, {255, 255, 60}};
    static const int8_t normals[4][3] = {{0, 0, 127}, {0, 0, 127}, {0, 0, 127}, {0, 0, 127}};
    for (unsigned i = 0; i < 4; i++) {
        uvs[i][0] = (int16_t)(16 * (positions[i][0] < 0 ? least : most));
        uvs[i][1] = (int16_t)(16 * (positions[i][1] > 0 ? least : most));
    }
    return (el_mesh){.positions = positions,
                     .triangles = triangles,
                     .colours = colours,
                     .normals = normals,
                     .uvs = (const int16_t(*)[2])uvs,
                     .vertex_count = 4,
                     .triangle_count = 2,
                     .scale_log2 = SCALE_LOG2,
                     .radius = 5800};
}

/* --- Pictures --------------------------------------------------------------------------------------------------------------- */

static const char letter[PICTURE_SIDE][PICTURE_SIDE + 1] = {
    "................", ".##############.", ".##############.", ".###............",
    ".###............", ".###............", ".###............", ".##########.....",
    ".##########.....", ".###............", ".###............", ".###............",
    ".###............", ".###............", ".###............", "................",
};

static void paint_pictures(void)
{
    static uint8_t index8[PICTURE_SIDE * PICTURE_SIDE];
    static uint8_t index4[PICTURE_SIDE * PICTURE_SIDE / 2];
    static uint8_t mask[PICTURE_SIDE * PICTURE_SIDE / 8];
    static uint16_t palette8[256];
    static uint16_t palette4[16];
    static const uint16_t ink[1] = {0xFFFF};
    for (unsigned i = 0; i < 256; i++) {
        palette8[i] = el_rgb565((uint8_t)i, (uint8_t)(200 - i / 2), (uint8_t)(255 - i));
    }
    for (unsigned i = 0; i < 15; i++) {
        palette4[i] = palette8[i * 17];
    }
    palette4[15] = palette8[255] = 0xFFFF;
    for (unsigned i = 0; i < PICTURE_SIDE * PICTURE_SIDE; i++) {
        const unsigned x = i % PICTURE_SIDE;
        const unsigned y = i / PICTURE_SIDE;
        const bool is_ink = letter[y][x] == '#';
        const unsigned step = (x + y) / 2; /* 0 to 15; 15 is ink */
        picture[i] = is_ink ? 0xFFFF : el_rgb565((uint8_t)(60 + 12 * y), (uint8_t)(30 + 8 * x), 40);
        index8[i] = (uint8_t)(is_ink ? 255 : (x + y) * 8);
        index4[i / 2] |= (uint8_t)((is_ink || step == 15 ? 15 : step) << (x % 2 == 0 ? 4 : 0));
        mask[i / 8] |= (uint8_t)((is_ink ? 1 : 0) << (7 - x % 8));
        const int dx = 2 * (int)x - PICTURE_SIDE + 1;
        const int dy = 2 * (int)y - PICTURE_SIDE + 1;
        const int fall = dx * dx + dy * dy;
        glow[i] = (uint8_t)(fall > 255 ? 0 : 255 - fall);
    }
    for (unsigned i = 0; i < ODD_WIDTH * ODD_HEIGHT; i++) {
        odd_picture[i] = picture[i / ODD_WIDTH * PICTURE_SIDE + i % ODD_WIDTH];
    }
    image_rgb565 = (el_image){.width = PICTURE_SIDE, .height = PICTURE_SIDE, .pixels = picture};
    image_odd = (el_image){.width = ODD_WIDTH, .height = ODD_HEIGHT, .pixels = odd_picture};
    image_index8 = image_rgb565;
    image_index8.format = EL_IMAGE_INDEX8;
    image_index8.pixels = index8;
    image_index8.palette = palette8;
    image_index4 = image_rgb565;
    image_index4.format = EL_IMAGE_INDEX4;
    image_index4.pixels = index4;
    image_index4.palette = palette4;
    image_mask = image_rgb565;
    image_mask.format = EL_IMAGE_MASK;
    image_mask.pixels = mask;
    image_mask.palette = ink;
}

void make_things(void)
{
    static round_arrays ball_arrays, tube_arrays, cone_arrays;
    static int16_t uvs[3][4][2];
    static bool is_made;
    if (is_made) {
        return;
    }
    is_made = true;
    ball = make_round(&ball_arrays, ball_ring, false);
    ball.radius = ONE + 2;
    tube = make_round(&tube_arrays, tube_ring, false);
    cone = make_round(&cone_arrays, cone_ring, true);
    card = make_card(uvs[0], 0, PICTURE_SIDE);
    wide_card = make_card(uvs[1], -PICTURE_SIDE / 2, PICTURE_SIDE + PICTURE_SIDE / 2);
    floor_card = make_card(uvs[2], 0, 128);
    paint_pictures();
}

/* --- Where they stand ------------------------------------------------------------------------------------------------------- */

void place_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t target_q16[3] = {0, 0, 0};
    static const int32_t eye_q16[3] = {0, 0, TENTHS_Q16(80)};
    (void)frame;
    *camera = (el_camera){.fov_y = EL_DEGREES(5313, 100), .near_q16 = TENTHS_Q16(10), .far_q16 = TENTHS_Q16(800)};
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16); /* never from above */
}

el_pose at(int32_t x, int32_t y, int32_t z, int32_t scale)
{
    el_pose pose = el_pose_identity();
    pose.position_q16[0] = TENTHS_Q16(x);
    pose.position_q16[1] = TENTHS_Q16(y);
    pose.position_q16[2] = TENTHS_Q16(z);
    pose.scale_q16 = (uint32_t)TENTHS_Q16(scale);
    return pose;
}

el_pose turned(el_pose pose, el_angle about_x, el_angle about_y)
{
    el_pose_turn(&pose, EL_AXIS_X, about_x);
    el_pose_turn(&pose, EL_AXIS_Y, about_y);
    return pose;
}
