/* CRC-32 against its check value and against the polynomial, bit by bit. */
#include "base/crc32.h"

#include "fake_link.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_check_value(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926, el_crc32(0, "123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0, el_crc32(0, "", 0));
}

/* The CRC of one byte b is ~(entries[b ^ 0xFF] ^ 0x00FFFFFF), so 256 bytes show all entries. */
static void test_every_table_entry(void)
{
    for (uint32_t value = 0; value < 256; value++) {
        uint8_t byte = (uint8_t)value;
        TEST_ASSERT_EQUAL_HEX32(plain_crc32(&byte, 1), el_crc32(0, &byte, 1));
    }
}

static void test_any_split_gives_the_same(void)
{
    uint8_t bytes[300];
    uint32_t seed = 1;

    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)random_u32(&seed);
    }
    for (size_t cut = 0; cut <= sizeof bytes; cut++) {
        uint32_t crc = el_crc32(el_crc32(0, bytes, cut), bytes + cut, sizeof bytes - cut);
        TEST_ASSERT_EQUAL_HEX32(plain_crc32(bytes, sizeof bytes), crc);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_value);
    RUN_TEST(test_every_table_entry);
    RUN_TEST(test_any_split_gives_the_same);
    return UNITY_END();
}
