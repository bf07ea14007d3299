/* COBS: the paper's blocks at every edge, the queue at every size, the decoder on what is no encoding. */
#include "base/cobs.h"

#include "fake_link.h"

enum { MAX_PACKET = 1100, GUARD = 0xA5 };

_Static_assert(EL_COBS_MAX_BYTES(0) == 1 && EL_COBS_MAX_BYTES(1) == 2, "an encoding has at least one byte");
_Static_assert(EL_COBS_MAX_BYTES(254) == 255 && EL_COBS_MAX_BYTES(255) == 257, "one code byte per 254");
_Static_assert(EL_COBS_MAX_BYTES(508) == 510 && EL_COBS_MAX_BYTES(509) == 512, "one code byte per 254");

static uint32_t seed;

void setUp(void)
{
    seed = 20261121;
}

void tearDown(void)
{
}

/* Encodes through a queue of `capacity` bytes between guards; the link takes `most` bytes at a time. */
static size_t encode(const uint8_t *packet, size_t count, uint16_t capacity, size_t most, uint8_t *wire)
{
    uint8_t buffer[2048];
    el_cobs_encoder queue;
    size_t size = 0;
    size_t at = 0;
    bool ended = false;

    memset(buffer, GUARD, sizeof buffer);
    el_cobs_init(&queue, buffer + 1, capacity);
    TEST_ASSERT_GREATER_THAN_UINT32(0, el_cobs_room(&queue));
    uint32_t begin = el_cobs_position(&queue);
    el_cobs_begin(&queue);
    for (;;) {
        size_t final;
        const uint8_t *bytes = el_cobs_final(&queue, &final);
        final = final < most ? final : most;
        memcpy(wire + size, bytes, final);
        size += final;
        el_cobs_take(&queue, final);
        if (at < count) {
            at += el_cobs_put(&queue, packet + at, 1 + random_below(&seed, (uint32_t)(count - at)));
        } else if (!ended) {
            el_cobs_end(&queue);
            ended = true;
        } else if (final == 0) {
            break;
        }
    }
    TEST_ASSERT_EQUAL_UINT8(GUARD, buffer[0]);
    TEST_ASSERT_EQUAL_UINT8(GUARD, buffer[1 + capacity]);
    TEST_ASSERT_EQUAL_UINT32(size, el_cobs_position(&queue) - begin);
    return size;
}

static void check(const uint8_t *packet, size_t count, uint16_t capacity, size_t most)
{
    uint8_t wire[2 * MAX_PACKET];
    uint8_t plain[2 * MAX_PACKET];
    size_t size = encode(packet, count, capacity, most, wire);
    size_t plain_size = plain_cobs_encode(packet, count, plain);

    plain[plain_size] = 0;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(EL_COBS_MAX_BYTES(count), plain_size);
    TEST_ASSERT_EQUAL_UINT32(plain_size + 1, size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(plain, wire, size);
    TEST_ASSERT_EQUAL_INT32((int32_t)count, el_cobs_decode(wire, size - 1));
    TEST_ASSERT_EQUAL_UINT32(count, plain_cobs_decode(plain, plain_size, plain + plain_size));
    if (count > 0) {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(packet, wire, count);
    }
}

/* Examples from the COBS article in the English Wikipedia, "Encoding examples", and of the Python package cobs. */
static void test_vectors(void)
{
    static const struct {
        const char *packet;
        const char *wire;
    } vectors[] = {
        {"", "01 00"},
        {"00", "01 01 00"},
        {"00 00", "01 01 01 00"},
        {"00 11 00", "01 02 11 01 00"},
        {"11 22 00 33", "03 11 22 02 33 00"},
        {"11 22 33 44", "05 11 22 33 44 00"},
        {"11 00 00 00", "02 11 01 01 01 00"},
    };
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        uint8_t packet[16];
        uint8_t expected[16];
        uint8_t wire[32];
        size_t count = from_hex(vectors[i].packet, packet);
        size_t size = from_hex(vectors[i].wire, expected);
        TEST_ASSERT_EQUAL_UINT32(size, encode(packet, count, EL_COBS_ENCODER_MIN_BYTES, 99, wire));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, wire, size);
    }
}

/* Around one, two and four full blocks: no 00 at all, a 00 at the end, at the beginning, at each block's end. */
static void test_block_edges(void)
{
    static const size_t lengths[] = {0, 1, 2, 252, 253, 254, 255, 256, 507, 508, 509, 510, 762, 763, 1016, 1017};
    uint8_t packet[MAX_PACKET];

    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        size_t count = lengths[i];
        for (size_t zero = 0; zero <= count; zero++) {
            memset(packet, 0x11, sizeof packet);
            if (zero < count) {
                packet[zero] = 0;
            }
            check(packet, count, EL_COBS_ENCODER_MIN_BYTES, 600);
        }
        memset(packet, 0, sizeof packet);
        check(packet, count, EL_COBS_ENCODER_MIN_BYTES, 600);
    }
}

static void test_seeded_packets_through_queues_of_all_sizes(void)
{
    uint8_t packet[MAX_PACKET];

    for (int round = 0; round < 3000; round++) {
        size_t count = random_below(&seed, MAX_PACKET);
        uint32_t values = 1U << random_below(&seed, 9); /* few values: many 00; 256: few */
        for (size_t i = 0; i < count; i++) {
            packet[i] = (uint8_t)random_below(&seed, values);
        }
        uint16_t capacity = (uint16_t)(EL_COBS_ENCODER_MIN_BYTES + random_below(&seed, 700));
        check(packet, count, capacity, 1 + random_below(&seed, 300));
    }
}

/* The smallest queue makes progress even when an open block fills it. */
static void test_a_drained_queue_takes_a_byte(void)
{
    uint8_t buffer[EL_COBS_ENCODER_MIN_BYTES];
    uint8_t packet[254];
    el_cobs_encoder queue;
    size_t final;

    memset(packet, 0x11, sizeof packet);
    el_cobs_init(&queue, buffer, sizeof buffer);
    el_cobs_begin(&queue);
    for (size_t at = 0; at < sizeof packet;) {
        size_t put = el_cobs_put(&queue, packet + at, sizeof packet - at);
        TEST_ASSERT_GREATER_THAN_UINT32(0, put);
        at += put;
    }
    el_cobs_final(&queue, &final);
    TEST_ASSERT_EQUAL_UINT32(0, final);
    TEST_ASSERT_EQUAL_UINT32(1, el_cobs_put(&queue, packet, 1));
    TEST_ASSERT_EQUAL_UINT32(0, el_cobs_put(&queue, packet, 1));
    el_cobs_end(&queue);
    el_cobs_final(&queue, &final);
    TEST_ASSERT_EQUAL_UINT32(sizeof buffer, final);
}

static void test_delimiter_and_discard(void)
{
    uint8_t buffer[300];
    el_cobs_encoder queue;
    size_t final;

    el_cobs_init(&queue, buffer, sizeof buffer);
    el_cobs_begin(&queue);
    el_cobs_put(&queue, "abc", 3);
    el_cobs_discard(&queue);
    el_cobs_delimit(&queue);
    el_cobs_begin(&queue);
    el_cobs_put(&queue, "d", 1);
    el_cobs_end(&queue);
    TEST_ASSERT_EQUAL_HEX8_ARRAY("\0\2d\0", el_cobs_final(&queue, &final), 4);
    TEST_ASSERT_EQUAL_UINT32(4, final);
}

/* el_cobs_room promises: that many bytes, whatever they are, go in without taking. */
static void test_room_is_kept(void)
{
    for (uint16_t capacity = EL_COBS_ENCODER_MIN_BYTES; capacity < 1100; capacity++) {
        uint8_t buffer[1101];
        uint8_t packet[1100];
        el_cobs_encoder queue;
        uint32_t stretch = 252 + random_below(&seed, 5); /* of bytes that are not 00, around a full block's 254 */
        size_t most = random_below(&seed, 2) == 0 ? 40 : sizeof packet;

        for (size_t i = 0; i < sizeof packet; i++) {
            packet[i] = i % stretch == stretch - 1 ? 0 : 1;
        }
        buffer[capacity] = GUARD;
        el_cobs_init(&queue, buffer, capacity);
        for (size_t room = el_cobs_room(&queue); room > 0; room = el_cobs_room(&queue)) {
            size_t count = room < most ? room : most;
            el_cobs_delimit(&queue);
            el_cobs_begin(&queue);
            TEST_ASSERT_EQUAL_UINT32(count, el_cobs_put(&queue, packet, count));
            el_cobs_end(&queue);
            TEST_ASSERT_EQUAL_UINT8(GUARD, buffer[capacity]);
        }
    }
}

static void test_what_is_no_encoding(void)
{
    static const struct {
        const char *bytes;
        int32_t result;
    } vectors[] = {
        {"", EL_COBS_CUT},          {"00", EL_COBS_ZERO},          {"02", EL_COBS_CUT},
        {"03 11", EL_COBS_CUT},     {"02 11 02", EL_COBS_CUT},     {"FF 11", EL_COBS_CUT},
        {"03 11 00", EL_COBS_ZERO}, {"02 11 00 11", EL_COBS_ZERO}, {"05 00 11", EL_COBS_CUT},
    };
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        uint8_t bytes[16];
        size_t count = from_hex(vectors[i].bytes, bytes);
        TEST_ASSERT_EQUAL_INT32_MESSAGE(vectors[i].result, el_cobs_decode(bytes, count), vectors[i].bytes);
    }
}

/* Any bytes: never out of bounds (the sanitizers watch), and the same as the twin where that decodes. */
static void test_seeded_noise_decodes_as_the_twin_does(void)
{
    int decoded = 0;
    for (int round = 0; round < 100000; round++) {
        size_t count = 1 + random_below(&seed, 12);
        uint8_t *bytes = malloc(count);
        uint8_t plain[16];
        for (size_t i = 0; i < count; i++) {
            bytes[i] = (uint8_t)(1 + random_below(&seed, 5));
        }
        size_t plain_size = plain_cobs_decode(bytes, count, plain);
        int32_t size = el_cobs_decode(bytes, count);
        if (size > 0) {
            TEST_ASSERT_EQUAL_UINT32(plain_size, (size_t)size);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(plain, bytes, plain_size);
            decoded++;
        } else {
            TEST_ASSERT_EQUAL_UINT32(0, plain_size);
        }
        free(bytes);
    }
    TEST_ASSERT_GREATER_THAN_INT(10000, decoded);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_vectors);
    RUN_TEST(test_block_edges);
    RUN_TEST(test_seeded_packets_through_queues_of_all_sizes);
    RUN_TEST(test_a_drained_queue_takes_a_byte);
    RUN_TEST(test_delimiter_and_discard);
    RUN_TEST(test_room_is_kept);
    RUN_TEST(test_what_is_no_encoding);
    RUN_TEST(test_seeded_noise_decodes_as_the_twin_does);
    return UNITY_END();
}
