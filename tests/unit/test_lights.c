/* Lit colours against the header's formula in floating point. */
#include <math.h>

#include "edgeline.h"
#include "seeded.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

enum { VERTICES = 30, TRIANGLES = 20, LAMPS = 5 };

typedef struct vector {
    double x, y, z;
} vector;

static int16_t positions[VERTICES][3];
static int8_t normals[VERTICES][3];
static uint8_t own[VERTICES][3];
static uint16_t triangles[TRIANGLES][3];
static uint8_t lit[VERTICES][3];
static el_lamp lamps[LAMPS];
static el_lighting lighting;
static el_highlight highlight;
static el_mesh mesh;
static el_pose pose;
static int32_t eye_q16[3];

static double dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector along(vector a, vector b, double factor)
{
    return (vector){a.x + b.x * factor, a.y + b.y * factor, a.z + b.z * factor};
}

static vector unit(vector v)
{
    const double length = sqrt(dot(v, v));
    return (vector){v.x / length, v.y / length, v.z / length};
}

static vector of_q(const int32_t v[3], double one)
{
    return (vector){v[0] / one, v[1] / one, v[2] / one};
}

static vector turned(vector v)
{
    double out[3];
    for (unsigned i = 0; i < 3; i++) {
        const vector row = of_q(pose.rotation_q30[i], EL_UNIT_Q30);
        out[i] = dot(row, v);
    }
    return (vector){out[0], out[1], out[2]};
}

/* Between 0 and 1, all of it. */
static double arrives(const el_lamp *lamp, vector place, vector *to_lamp)
{
    if (lamp->kind == EL_LAMP_DIRECTIONAL) {
        *to_lamp = of_q(lamp->direction_q30, EL_UNIT_Q30);
        return 1;
    }
    const vector v = along(of_q(lamp->position_q16, EL_UNIT_Q16), place, -1);
    *to_lamp = unit(v);
    const double half = lamp->half_q16 / 65536.0;
    double part = half == 0 ? 1 : 1 / (1 + dot(v, v) / half / half);
    if (lamp->kind == EL_LAMP_SPOT) {
        const double cosine = -dot(*to_lamp, of_q(lamp->direction_q30, EL_UNIT_Q30));
        const double inner = lamp->inner_q30 / (double)EL_UNIT_Q30;
        const double outer = lamp->outer_q30 / (double)EL_UNIT_Q30;
        const double t = fmin(fmax((cosine - outer) / (inner - outer), 0), 1);
        part *= t * t * (3 - 2 * t);
    }
    return part;
}

static void expect_colour(const seeded *s, vector model, vector normal, const uint8_t colour[3], const uint8_t found[3])
{
    const double scale = ldexp(pose.scale_q16 / 65536.0, mesh.scale_log2);
    const vector place = along(of_q(pose.position_q16, EL_UNIT_Q16), turned(model), scale);
    const vector to_eye = unit(along(of_q(eye_q16, EL_UNIT_Q16), place, -1));
    vector n = unit(turned(normal));
    if (lighting.two_sided && dot(n, to_eye) < 0) {
        n = along((vector){0, 0, 0}, n, -1);
    }
    double sums[3] = {0};
    for (unsigned i = 0; i < 3; i++) {
        sums[i] = lighting.emissive[i] + colour[i] * (lighting.ambient[i] / 255.0);
    }
    for (unsigned k = 0; k < lighting.lamp_count; k++) {
        vector to_lamp;
        const double part = arrives(&lamps[k], place, &to_lamp);
        const double cosine = dot(n, to_lamp);
        if (cosine <= 0) {
            continue;
        }
        const double shine =
            lighting.highlight == NULL ? 0 : pow(fmax(dot(n, unit(along(to_lamp, to_eye, 1))), 0), highlight.exponent);
        for (unsigned i = 0; i < 3; i++) {
            sums[i] += lamps[k].colour[i] / 255.0 * part * (colour[i] * cosine + lighting.specular[i] * shine);
        }
    }
    for (unsigned i = 0; i < 3; i++) {
        const double expected = fmin(sums[i], 255);
        if (fabs(found[i] - expected) > 1) {
            fail_at(s, "channel %u is %u, not %d/1000", i, found[i], (int)(expected * 1000));
        }
    }
}

static void any_bytes(seeded *s, uint8_t bytes[3], uint32_t limit)
{
    for (unsigned i = 0; i < 3; i++) {
        bytes[i] = (uint8_t)any_below(s, limit);
    }
}

static void any_direction(seeded *s, int32_t direction_q30[3])
{
    vector v = {(double)any_between(s, -100, 100), (double)any_between(s, -100, 100), 0.5};
    v = unit(v);
    direction_q30[0] = (int32_t)(v.x * EL_UNIT_Q30);
    direction_q30[1] = (int32_t)(v.y * EL_UNIT_Q30);
    direction_q30[2] = (int32_t)(v.z * EL_UNIT_Q30);
}

static void any_lighting(seeded *s)
{
    for (unsigned i = 0; i < LAMPS; i++) {
        el_lamp *const lamp = &lamps[i];
        *lamp = (el_lamp){.kind = (uint8_t)any_below(s, 3),
                          .half_q16 = any_below(s, 4) == 0 ? 0U : (uint32_t)any_between(s, 4096, 40 * EL_UNIT_Q16)};
        any_bytes(s, lamp->colour, 256);
        any_direction(s, lamp->direction_q30);
        for (unsigned k = 0; k < 3; k++) {
            lamp->position_q16[k] = (int32_t)any_between(s, -20 * EL_UNIT_Q16, 20 * EL_UNIT_Q16);
        }
        lamp->outer_q30 = (int32_t)any_between(s, -EL_UNIT_Q30, EL_UNIT_Q30 * 9LL / 10);
        lamp->inner_q30 = (int32_t)any_between(s, lamp->outer_q30 + EL_UNIT_Q30 / 64, EL_UNIT_Q30);
    }
    lighting = (el_lighting){.lamps = lamps,
                             .lamp_count = (uint8_t)any_below(s, LAMPS + 1),
                             .highlight = any_below(s, 4) == 0 ? NULL : &highlight,
                             .two_sided = any_below(s, 2) == 0};
    const uint32_t exponent = any_below(s, 2) == 0 ? 1 + any_below(s, 12) : 1 + any_below(s, EL_HIGHLIGHT_EXPONENT_MAX);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_highlight_make(&highlight, exponent));
    any_bytes(s, lighting.ambient, 80);
    any_bytes(s, lighting.emissive, 30);
    any_bytes(s, lighting.specular, any_below(s, 2) == 0 ? 1 : 256);
    any_bytes(s, lighting.colour, 256);
}

static void any_mesh(seeded *s)
{
    for (unsigned i = 0; i < VERTICES; i++) {
        for (unsigned k = 0; k < 3; k++) {
            positions[i][k] = (int16_t)any_between(s, -32768, 32767);
            /* All on one side, so that no mean of normals is short. */
            normals[i][k] = (int8_t)any_between(s, 5, 127);
        }
        any_bytes(s, own[i], 256);
    }
    for (unsigned i = 0; i < TRIANGLES; i++) {
        for (unsigned k = 0; k < 3; k++) {
            triangles[i][k] = (uint16_t)any_below(s, VERTICES);
        }
    }
    mesh = (el_mesh){.positions = (const int16_t(*)[3])positions,
                     .normals = (const int8_t(*)[3])normals,
                     .triangles = (const uint16_t(*)[3])triangles,
                     .colours = any_below(s, 2) == 0 ? (const uint8_t(*)[3])own : NULL,
                     .vertex_count = VERTICES,
                     .triangle_count = TRIANGLES,
                     .scale_log2 = -13};
    pose = el_pose_identity();
    pose.scale_q16 = (uint32_t)any_between(s, 1 << 14, 1 << 17);
    for (unsigned k = 0; k < 3; k++) {
        el_pose_turn(&pose, (el_axis)k, (el_angle)any_u64(s));
        pose.position_q16[k] = (int32_t)any_between(s, -10 * EL_UNIT_Q16, 10 * EL_UNIT_Q16);
        eye_q16[k] = (int32_t)any_between(s, -30 * EL_UNIT_Q16, 30 * EL_UNIT_Q16);
    }
}

static vector position_of(uint16_t v)
{
    return (vector){positions[v][0], positions[v][1], positions[v][2]};
}

static vector normal_of(uint16_t v)
{
    return (vector){normals[v][0], normals[v][1], normals[v][2]};
}

static void test_vertices(void)
{
    for (seeded s = seeded_from(931); s.round < PART_OF(1000U); s.round++) {
        any_lighting(&s);
        any_mesh(&s);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_light_vertices(&lighting, &mesh, &pose, eye_q16, lit));
        for (uint16_t v = 0; v < VERTICES; v++) {
            expect_colour(&s, position_of(v), normal_of(v), mesh.colours != NULL ? own[v] : lighting.colour, lit[v]);
        }
    }
}

static void test_triangles(void)
{
    for (seeded s = seeded_from(932); s.round < PART_OF(1000U); s.round++) {
        any_lighting(&s);
        any_mesh(&s);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_light_triangles(&lighting, &mesh, &pose, eye_q16, lit));
        for (unsigned t = 0; t < TRIANGLES; t++) {
            vector place = {0, 0, 0};
            vector normal = {0, 0, 0};
            for (unsigned k = 0; k < 3; k++) {
                place = along(place, position_of(triangles[t][k]), 1 / 3.0);
                normal = along(normal, normal_of(triangles[t][k]), 1);
            }
            const uint8_t *const colour = mesh.colours != NULL ? own[triangles[t][0]] : lighting.colour;
            expect_colour(&s, place, normal, colour, lit[t]);
        }
    }
}

/* Entries against powers in floating point, and nothing but what is less than e^-10 behind them. */
static void test_highlights(void)
{
    for (uint32_t exponent = 1; exponent <= EL_HIGHLIGHT_EXPONENT_MAX; exponent++) {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_highlight_make(&highlight, exponent));
        for (int i = 0; i <= EL_HIGHLIGHT_STEPS; i++) {
            const double c = fmax(1 - ldexp(i, EL_HIGHLIGHT_STEP_LOG2) / exponent, 0);
            const double power = ldexp(pow(c, exponent), 15);
            if (fabs(highlight.power_q15[i] - power) > 0.6) {
                TEST_FAIL_MESSAGE("an entry is off by more than its rounding");
            }
        }
        TEST_ASSERT_EQUAL_UINT16(1 << 15, highlight.power_q15[0]);
        TEST_ASSERT_LESS_OR_EQUAL_UINT16(1, highlight.power_q15[EL_HIGHLIGHT_STEPS]);
    }
}

/* Places that no arithmetic should stumble over: the lamp in the surface, the eye there, normals of no length, scales that
 * lead out of the world. */
static void test_nothing_is_undefined(void)
{
    for (seeded s = seeded_from(933); s.round < PART_OF(2000U); s.round++) {
        any_lighting(&s);
        any_mesh(&s);
        pose.scale_q16 = (uint32_t)any_of_bits(&s, 32);
        mesh.scale_log2 = (int8_t)any_between(&s, -30, 8);
        for (unsigned k = 0; k < 3; k++) {
            pose.position_q16[k] = (int32_t)any_signed_of_bits(&s, 31);
            eye_q16[k] = any_below(&s, 2) == 0 ? pose.position_q16[k] : (int32_t)any_signed_of_bits(&s, 31);
            lamps[0].position_q16[k] = pose.position_q16[k];
            lamps[1].position_q16[k] = (int32_t)any_signed_of_bits(&s, 31);
            lamps[1].direction_q30[k] = (int32_t)any_signed_of_bits(&s, 31);
            positions[0][k] = 0;
            normals[1][k] = 0;
        }
        lamps[0].half_q16 = (uint32_t)any_of_bits(&s, 32);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_light_vertices(&lighting, &mesh, &pose, eye_q16, lit));
        TEST_ASSERT_EQUAL_INT(EL_OK, el_light_triangles(&lighting, &mesh, &pose, eye_q16, lit));
    }
}

static void expect(el_status status)
{
    TEST_ASSERT_EQUAL_INT(status, el_light_vertices(&lighting, &mesh, &pose, eye_q16, lit));
    TEST_ASSERT_EQUAL_INT(status, el_light_triangles(&lighting, &mesh, &pose, eye_q16, lit));
}

static void test_what_is_refused(void)
{
    seeded s = seeded_from(934);
    any_lighting(&s);
    any_mesh(&s);
    lighting.lamp_count = 1;
    lamps[0].kind = EL_LAMP_SPOT;
    expect(EL_OK);
    lamps[0].outer_q30 = lamps[0].inner_q30;
    expect(EL_ERROR_MATERIAL);
    lamps[0].kind = EL_LAMP_SPOT + 1;
    expect(EL_ERROR_MATERIAL);
    lamps[0].kind = EL_LAMP_POINT;
    mesh.normals = NULL;
    expect(EL_ERROR_MATERIAL);
    mesh.normals = (const int8_t(*)[3])normals;
    lighting.lamp_count = EL_LAMPS_MAX + 1;
    expect(EL_ERROR_SIZE);
    lighting.lamp_count = 0;
    lighting.highlight = &highlight;
    highlight.exponent = 0;
    expect(EL_ERROR_MATERIAL);
    highlight.exponent = EL_HIGHLIGHT_EXPONENT_MAX + 1;
    expect(EL_ERROR_MATERIAL);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_highlight_make(&highlight, 0));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_highlight_make(&highlight, EL_HIGHLIGHT_EXPONENT_MAX + 1));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_light_vertices(NULL, &mesh, &pose, eye_q16, lit));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_light_triangles(&lighting, &mesh, &pose, NULL, lit));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_vertices);
    RUN_TEST(test_triangles);
    RUN_TEST(test_highlights);
    RUN_TEST(test_nothing_is_undefined);
    RUN_TEST(test_what_is_refused);
    return UNITY_END();
}
