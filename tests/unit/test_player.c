/* The player: INPUT chooses the scene, its frame and whether it goes on, moves the camera and changes the look, and never
 * disturbs the frame under way. */
#include <string.h>

#include "player.h"
#include "recording_sink.h"
#include "seeded.h"

enum { WIDTH = 64, HEIGHT = 48 };

static el_player player;
static el_renderer renderer;
static uint8_t memory[EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, HEIGHT) + 4096];
static void (*on_rows)(void);
static recording record;
static el_sink sink;

static void rows(void *context, el_band *band, unsigned slot)
{
    record_rows(context, band, slot);
    if (on_rows != NULL) {
        on_rows();
    }
}

void setUp(void)
{
    on_rows = NULL;
    memset(&record, 0, sizeof record);
    sink = recording_sink(&record);
    sink.rows = rows;
    player = (el_player){.scene = el_scene_find("demo")};
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = HEIGHT,
                              .memory = memory,
                              .memory_bytes = sizeof memory,
                              .sinks = {&sink}};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
}

void tearDown(void)
{
}

static void test_frames_follow_each_other_until_paused(void)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_UINT32(2, player.frame);
    el_player_input(&player, EL_CONTROL_PAUSE, 1);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_UINT32(2, player.frame);
    el_player_input(&player, EL_CONTROL_FRAME, 40);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_UINT32(40, player.frame);
    el_player_input(&player, EL_CONTROL_PAUSE, 0);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_UINT32(41, player.frame);
}

static void test_a_scene_that_stands_still_goes_on_by_steps(void)
{
    el_player_input(&player, EL_CONTROL_STEP, 3); /* it does not stand still */
    TEST_ASSERT_EQUAL_UINT32(0, player.frame);
    el_player_input(&player, EL_CONTROL_PAUSE, 1);
    el_player_input(&player, EL_CONTROL_STEP, 3);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_UINT32(3, player.frame);
    el_player_input(&player, EL_CONTROL_STEP, INT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(3U + INT32_MAX, player.frame);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
}

static void test_every_scene_can_be_chosen_and_has_its_background(void)
{
    for (size_t i = 0; i < el_scene_count(); i++) {
        el_player_input(&player, EL_CONTROL_FRAME, 5);
        el_player_input(&player, EL_CONTROL_SCENE, (int32_t)i);
        TEST_ASSERT_EQUAL_PTR(el_scene_at(i), player.scene);
        TEST_ASSERT_EQUAL_UINT32(0, player.frame);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
        TEST_ASSERT_EQUAL_HEX16(el_scene_at(i)->background, renderer.config.background);
    }
}

static void test_what_is_not_there_is_ignored(void)
{
    const el_player before = {.scene = el_scene_find("teapot"),
                              .frame = 3,
                              .paused = true,
                              .orbit = {.yaw = 1, .pitch = 2, .zoom_q8 = 3, .pan_q8 = {4, 5}},
                              .shading_off = 1,
                              .texture_error = 2};
    const struct {
        uint8_t control;
        int32_t value;
    } inputs[] = {{EL_CONTROL_SCENE, -1},
                  {EL_CONTROL_SCENE, (int32_t)el_scene_count()},
                  {EL_CONTROL_FRAME, -1},
                  {EL_CONTROL_PAUSE, 2},
                  {EL_CONTROL_PAUSE, -1},
                  {EL_CONTROL_STEP, 0},
                  {EL_CONTROL_STEP, -1},
                  {EL_CONTROL_PITCH, 16385},
                  {EL_CONTROL_PITCH, -16385},
                  {EL_CONTROL_ZOOM, 1025},
                  {EL_CONTROL_ZOOM, INT32_MIN},
                  {EL_CONTROL_PAN_X, 4097},
                  {EL_CONTROL_PAN_Y, -4097},
                  {EL_CONTROL_SHADING, 4},
                  {EL_CONTROL_SHADING, -1},
                  {EL_CONTROL_TEXTURE_ERROR, 6},
                  {EL_CONTROL_TEXTURE_ERROR, -1},
                  {EL_CONTROL_VIEW, EL_DEBUG_VIEWS},
                  {EL_CONTROL_VIEW, -1},
                  {EL_CONTROL_ANTIALIASING, 4},
                  {0, 0},
                  {14, 1},
                  {32 + EL_CONTROL_SCENE, 0},
                  {255, 1}};
    TEST_ASSERT_NOT_NULL(before.scene);
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        player = before;
        el_player_input(&player, inputs[i].control, inputs[i].value);
        TEST_ASSERT_EQUAL_MEMORY(&before, &player, sizeof player);
    }
}

static void test_each_control_has_its_place(void)
{
    el_player_input(&player, EL_CONTROL_YAW, -1);
    el_player_input(&player, EL_CONTROL_PITCH, -16384);
    el_player_input(&player, EL_CONTROL_ZOOM, 1024);
    el_player_input(&player, EL_CONTROL_PAN_X, -4096);
    el_player_input(&player, EL_CONTROL_PAN_Y, 4096);
    el_player_input(&player, EL_CONTROL_TEXTURE_ERROR, 5);
    TEST_ASSERT_EQUAL_UINT16(65535, player.orbit.yaw);
    TEST_ASSERT_EQUAL_INT16(-16384, player.orbit.pitch);
    TEST_ASSERT_EQUAL_INT16(1024, player.orbit.zoom_q8);
    TEST_ASSERT_EQUAL_INT16(-4096, player.orbit.pan_q8[0]);
    TEST_ASSERT_EQUAL_INT16(4096, player.orbit.pan_q8[1]);
    TEST_ASSERT_EQUAL_UINT8(5, player.texture_error);
    el_player_input(&player, EL_CONTROL_YAW, 65536 + 7);
    TEST_ASSERT_EQUAL_UINT16(7, player.orbit.yaw);
}

/* SHADING: flat; no textures; no vertex colours. */
static void test_shadings_are_what_the_wire_says(void)
{
    static const uint8_t off[] = {0, EL_SHADE_TEXTURED_GOURAUD, EL_SHADE_TEXTURED, EL_SHADE_GOURAUD};
    for (int32_t value = 0; value < 4; value++) {
        el_player_input(&player, EL_CONTROL_SHADING, value);
        TEST_ASSERT_EQUAL_UINT8(off[value] & EL_DEBUG_SHADINGS, player.shading_off);
    }
}

/* HELLO's masks: what the player says that it knows is what it takes. */
static void test_it_knows_what_it_says(void)
{
    for (unsigned control = 0; control < 32; control++) {
        bool takes = false;
        for (int32_t value = 0; value < 8; value++) {
            const el_player before = {.scene = el_scene_at(1), .paused = true, .frame = 9};
            player = before;
            el_player_input(&player, (uint8_t)control, value);
            takes = takes || memcmp(&player, &before, sizeof player) != 0;
        }
        TEST_ASSERT_EQUAL(takes, EL_PLAYER_CONTROLS >> control & 1U);
    }
    TEST_ASSERT_EQUAL_HEX16(EL_WITH_DEBUG_VIEWS ? 63 : 0, EL_PLAYER_VIEWS);
}

static uint32_t play(void)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    return recorded_crc(&record);
}

/* Each control changes the picture, and its 0 brings the old one back. */
static void test_zero_brings_the_scene_back_as_it_is_made(void)
{
    static const struct {
        uint8_t control;
        int32_t value;
    } inputs[] = {{EL_CONTROL_YAW, -5000}, {EL_CONTROL_PITCH, 3000},      {EL_CONTROL_ZOOM, -300},
                  {EL_CONTROL_PAN_X, 80},  {EL_CONTROL_PAN_Y, -60},       {EL_CONTROL_SHADING, 1},
                  {EL_CONTROL_SHADING, 2}, {EL_CONTROL_TEXTURE_ERROR, 1}, {EL_CONTROL_VIEW, 1},
                  {EL_CONTROL_VIEW, 2},    {EL_CONTROL_VIEW, 3},          {EL_CONTROL_VIEW, 4},
                  {EL_CONTROL_VIEW, 5}};
    player = (el_player){.scene = el_scene_find("room"), .paused = true};
    renderer.config.uv_error_log2 = 5;
    const uint32_t picture = play();
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        const bool is_known = (EL_PLAYER_CONTROLS >> inputs[i].control & 1U) != 0;
        el_player_input(&player, inputs[i].control, inputs[i].value);
        const bool changes = play() != picture;
        TEST_ASSERT_EQUAL_MESSAGE(is_known, changes, "a control without an effect, or with a secret one");
        el_player_input(&player, inputs[i].control, 0);
        TEST_ASSERT_EQUAL_HEX32(picture, play());
    }
    TEST_ASSERT_EQUAL_UINT8(5, renderer.config.uv_error_log2);
}

/* Whatever a host sends, each frame of every scene can be drawn. */
static void test_no_control_makes_a_frame_fail(void)
{
    for (seeded s = seeded_from(530); s.round < PART_OF(10000); s.round++) {
        for (unsigned i = any_below(&s, 4); i < 4; i++) {
            const uint8_t control = (uint8_t)any_between(&s, 0, EL_CONTROL_VIEW + 1);
            const bool small = control <= EL_CONTROL_PAUSE || control >= EL_CONTROL_SHADING;
            const int64_t far[] = {-65536, -16384, -4096, -1024, -1, 1, 1024, 4096, 16384, 65535};
            el_player_input(&player, control,
                            (int32_t)(small                   ? any_between(&s, -1, 12)
                                      : any_below(&s, 2) == 0 ? far[any_below(&s, 10)]
                                                              : any_between(&s, -4096, 4096)));
        }
        const el_status status = el_player_play(&player, &renderer);
        if (status != EL_OK) {
            fail_at(&s, "%s, frame %u: status %d; yaw %u, pitch %d, zoom %d, pan %d %d", player.scene->name,
                    (unsigned)player.frame, status, player.orbit.yaw, player.orbit.pitch, player.orbit.zoom_q8,
                    player.orbit.pan_q8[0], player.orbit.pan_q8[1]);
        }
    }
}

static void choose_in_the_middle(void)
{
    on_rows = NULL;
    el_player_input(&player, EL_CONTROL_SCENE, 1);
    el_player_input(&player, EL_CONTROL_FRAME, 7);
}

static void test_input_in_the_middle_of_a_frame_counts_for_the_next(void)
{
    on_rows = choose_in_the_middle;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_player_play(&player, &renderer));
    TEST_ASSERT_EQUAL_HEX16(el_scene_find("demo")->background, renderer.config.background);
    TEST_ASSERT_EQUAL_PTR(el_scene_at(1), player.scene);
    TEST_ASSERT_EQUAL_UINT32(7, player.frame);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_frames_follow_each_other_until_paused);
    RUN_TEST(test_a_scene_that_stands_still_goes_on_by_steps);
    RUN_TEST(test_every_scene_can_be_chosen_and_has_its_background);
    RUN_TEST(test_what_is_not_there_is_ignored);
    RUN_TEST(test_each_control_has_its_place);
    RUN_TEST(test_shadings_are_what_the_wire_says);
    RUN_TEST(test_it_knows_what_it_says);
    RUN_TEST(test_zero_brings_the_scene_back_as_it_is_made);
    RUN_TEST(test_no_control_makes_a_frame_fail);
    RUN_TEST(test_input_in_the_middle_of_a_frame_counts_for_the_next);
    return UNITY_END();
}
