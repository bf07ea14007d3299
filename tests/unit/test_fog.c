/* How much of the fog lies before a depth, against its law in floating point at the distance that the depth means. */
#include <math.h>
#include <stdlib.h>

#include "geometry/limits.h"
#include "raster/fog.h"
#include "seeded.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_MIXED

static el_fog fog;

static el_camera any_camera(seeded *s)
{
    const uint32_t near_q16 = (uint32_t)any_between(s, 16, 4 * EL_UNIT_Q16);
    const uint32_t least = near_q16 + near_q16 / 8 + 1;
    return (el_camera){.axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
                       .fov_y = EL_DEGREES(60, 1),
                       .near_q16 = near_q16,
                       .far_q16 = (uint32_t)any_between(s, least, least + (1 << any_between(s, 10, 29)))};
}

static double distance_of(const el_camera *camera, uint32_t depth)
{
    const double scale = fog.scale_q12 / 4096.0;
    return camera->near_q16 / 65536.0 * scale / (scale - depth);
}

/* All depths, or every so many: the largest difference from `law`, in 1/255. */
static double worst(const el_camera *camera, double (*law)(double distance, const double *values), const double *values)
{
    double most = 0;
    for (uint32_t depth = 0; depth <= EL_DEPTH_MAX; depth += 1 + EL_TEST_PART * 7) {
        const double expected = law(distance_of(camera, depth), values);
        most = fmax(most, fabs(el_fog_at(&fog, depth) / 256.0 - expected) * 255);
    }
    return most;
}

static double linear(double distance, const double *values)
{
    return fmin(fmax((distance - values[0]) / (values[1] - values[0]), 0), 1);
}

static double exponential(double distance, const double *values)
{
    return 1 - exp(-distance * values[0]);
}

static void test_linear_fog_keeps_to_its_law(void)
{
    for (seeded s = seeded_from(921); s.round < PART_OF(200U); s.round++) {
        const el_camera camera = any_camera(&s);
        const uint32_t range = camera.far_q16 - camera.near_q16;
        const uint32_t begin = (uint32_t)any_between(&s, 0, camera.near_q16 + range * 3 / 4);
        const uint32_t end = begin + camera.near_q16 + range / 16 + (uint32_t)any_between(&s, 1, range);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_fog_linear(&fog, &camera, 0, begin, end));
        const double values[2] = {begin / 65536.0, end / 65536.0};
        const double error = worst(&camera, linear, values);
        if (error > 1.5) {
            fail_at(&s, "fog is off by %d/25500", (int)(error * 100));
        }
    }
}

static void test_exponential_fog_keeps_to_its_law(void)
{
    for (seeded s = seeded_from(922); s.round < PART_OF(200U); s.round++) {
        const el_camera camera = any_camera(&s);
        const uint32_t density = (uint32_t)any_of_bits(&s, 24) + 1U;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_fog_exponential(&fog, &camera, 0, density));
        const double value = density / 65536.0;
        const double error = worst(&camera, exponential, &value);
        if (error > 1.5) {
            fail_at(&s, "fog of density %lu is off by %d/25500", (unsigned long)density, (int)(error * 100));
        }
    }
}

static void test_fog_that_is_refused(void)
{
    seeded s = seeded_from(923);
    el_camera camera = any_camera(&s);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_fog_exponential(&fog, &camera, 0, 0));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_fog_linear(&fog, &camera, 0, 2 * EL_UNIT_Q16, 2 * EL_UNIT_Q16));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_fog_linear(&fog, &camera, 0, 0, camera.near_q16));
    /* One that begins beyond the far plane is none. */
    TEST_ASSERT_EQUAL_INT(EL_OK, el_fog_linear(&fog, &camera, 0, UINT32_MAX - 1U, UINT32_MAX));
    TEST_ASSERT_TRUE(el_fog_is_made(&fog));
    TEST_ASSERT_EQUAL_UINT32(0, el_fog_at(&fog, EL_DEPTH_MAX));
    TEST_ASSERT_FALSE(el_fog_is_made(&(el_fog){0}));
    camera.projection = EL_ORTHOGRAPHIC;
    camera.height_q16 = EL_UNIT_Q16;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_CAMERA, el_fog_exponential(&fog, &camera, 0, 1));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_CAMERA, el_fog_linear(&fog, &camera, 0, 0, camera.far_q16));
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if EL_WITH_MIXED
    RUN_TEST(test_linear_fog_keeps_to_its_law);
    RUN_TEST(test_exponential_fog_keeps_to_its_law);
    RUN_TEST(test_fog_that_is_refused);
#endif
    return UNITY_END();
}
