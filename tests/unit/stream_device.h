/* A device for tests: a session on a fake link, and pictures that go through its sink as a renderer's would. */
#ifndef STREAM_DEVICE_H
#define STREAM_DEVICE_H

#include "fake_link.h"
#include "stream/sink.h"

enum { DEVICE_MAX_WIDTH = 128, DEVICE_MAX_HEIGHT = 128 };

typedef struct test_device {
    el_port port;
    el_stream stream;
    el_sink sink;
    uint16_t width;
    uint16_t height;
    uint16_t band_lines;
    uint16_t pixels[DEVICE_MAX_WIDTH * DEVICE_MAX_HEIGHT]; /* the picture of the next frame */
    uint8_t memory[EL_STREAM_MEMORY_BYTES(DEVICE_MAX_WIDTH, DEVICE_MAX_HEIGHT) +
                   EL_STREAM_SEGMENT_MEMORY_BYTES(DEVICE_MAX_WIDTH, DEVICE_MAX_HEIGHT) + 2];
    size_t memory_bytes;
    uint32_t inputs; /* in all */
    uint8_t control; /* of the last one */
    int32_t value;
} test_device;

enum { MEMORY_GUARD = 0xA5 };

static inline void device_input(void *context, uint8_t control, int32_t value)
{
    test_device *device = context;
    device->inputs++;
    device->control = control;
    device->value = value;
}

static inline el_stream_config device_config(test_device *device, uint16_t width, uint16_t height)
{
    return (el_stream_config){.port = &device->port,
                              .width = width,
                              .height = height,
                              .target = "pc1",
                              .firmware = "fw 2",
                              .boot_id = 0x01020304,
                              .baud = 115200,
                              .max_baud = 1000000,
                              .input = device_input,
                              .input_context = device,
                              .scenes = 5,
                              .controls = 0x3FFE,
                              .views = 0x3F,
                              .memory = device->memory + 1, /* odd on purpose */
                              .memory_bytes = EL_STREAM_MEMORY_BYTES(width, height)};
}

static inline void device_init(test_device *device, fake_link *link, uint16_t width, uint16_t height, bool one_way)
{
    memset(device, 0, sizeof *device);
    memset(device->memory, MEMORY_GUARD, sizeof device->memory);
    device->port = fake_port(link);
    device->width = width;
    device->height = height;
    device->band_lines = 8;
    el_stream_config config = device_config(device, width, height);
    config.one_way = one_way;
    device->memory_bytes = config.memory_bytes;
    TEST_ASSERT_EQUAL_INT(0, el_stream_init(&device->stream, &config));
    TEST_ASSERT_EQUAL_UINT32(0, (uintptr_t)device->stream.crcs % 4);
    device->sink = el_stream_sink(&device->stream);
}

/* The memory's neighbours are untouched. */
static inline void device_check_guards(const test_device *device)
{
    TEST_ASSERT_EQUAL_UINT8(MEMORY_GUARD, device->memory[0]);
    TEST_ASSERT_EQUAL_UINT8(MEMORY_GUARD, device->memory[1 + device->memory_bytes]);
}

/* One frame, as the renderer would draw it: each band in memory of its own size that is spoilt as soon as it is free. */
static inline void device_draw(test_device *device)
{
    el_stats stats;
    for (uint32_t i = 0; i < EL_STATS_COUNT; i++) {
        uint32_t counter = 100 + i;
        memcpy((uint8_t *)&stats + 4 * i, &counter, 4);
    }
    device->sink.begin(device->sink.context, device->width, device->height);
    for (uint32_t y = 0; y < device->height; y += device->band_lines) {
        uint32_t left = device->height - y;
        uint32_t lines = left < device->band_lines ? left : device->band_lines;
        size_t bytes = 2 * (size_t)lines * device->width;
        el_band band = {
            .pixels = malloc(bytes), .width = device->width, .y = (uint16_t)y, .lines = (uint16_t)lines, .held = {1}};
        TEST_ASSERT_NOT_NULL(band.pixels);
        memcpy(band.pixels, device->pixels + (size_t)y * device->width, bytes);
        device->sink.rows(device->sink.context, &band, 0);
        TEST_ASSERT_TRUE_MESSAGE(el_band_is_free(&band), "the stream keeps a band");
        free(band.pixels);
    }
    device->sink.end(device->sink.context, &stats);
    device_check_guards(device);
}

#endif
