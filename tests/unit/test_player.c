/* The player: INPUT chooses the scene, its frame and whether it goes on, and never disturbs the frame under way. */
#include <string.h>

#include "player.h"
#include "stream/session.h"
#include "unity.h"

enum { WIDTH = 16, HEIGHT = 8 };

static el_player player;
static el_renderer renderer;
static uint8_t memory[EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, HEIGHT) + 4096];
static void (*on_rows)(void);

static void begin(void *context, uint16_t width, uint16_t height)
{
    (void)context, (void)width, (void)height;
}

static void rows(void *context, el_band *band, unsigned slot)
{
    (void)context;
    el_band_release(band, slot);
    if (on_rows != NULL) {
        on_rows();
    }
}

static void end(void *context, const el_stats *stats)
{
    (void)context, (void)stats;
}

static const el_sink sink = {.begin = begin, .rows = rows, .end = end};

void setUp(void)
{
    on_rows = NULL;
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
    const el_player before = {.scene = el_scene_find("teapot"), .frame = 3, .paused = true};
    const struct {
        uint8_t control;
        int32_t value;
    } inputs[] = {{EL_CONTROL_SCENE, -1},
                  {EL_CONTROL_SCENE, (int32_t)el_scene_count()},
                  {EL_CONTROL_FRAME, -1},
                  {EL_CONTROL_PAUSE, 2},
                  {EL_CONTROL_PAUSE, -1},
                  {0, 0},
                  {4, 0},
                  {255, 1}};
    TEST_ASSERT_NOT_NULL(before.scene);
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        player = before;
        el_player_input(&player, inputs[i].control, inputs[i].value);
        TEST_ASSERT_EQUAL_PTR(before.scene, player.scene);
        TEST_ASSERT_EQUAL_UINT32(before.frame, player.frame);
        TEST_ASSERT_TRUE(player.paused);
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
    RUN_TEST(test_every_scene_can_be_chosen_and_has_its_background);
    RUN_TEST(test_what_is_not_there_is_ignored);
    RUN_TEST(test_input_in_the_middle_of_a_frame_counts_for_the_next);
    return UNITY_END();
}
