#include "stream/changes.h"

#include "base/crc32.h"

enum { SEGMENT_BYTES = 2 * EL_SPLIT_SEGMENT_PIXELS };

/* What becomes of a CRC when a segment follows it whose own CRC is then exclusive-or-ed in: a linear function of its bits,
 * here by nibbles, the lowest first. after_segment[n][v] is v << 4 n after SEGMENT_BYTES zero bytes;
 * tests/unit/test_stream_changes.c computes it afresh and compares. */
static const uint32_t after_segment[8][16] = {
    {0x00000000, 0x33FFF533, 0x67FFEA66, 0x54001F55, 0xCFFFD4CC, 0xFC0021FF, 0xA8003EAA, 0x9BFFCB99, 0x448EAFD9,
     0x77715AEA, 0x237145BF, 0x108EB08C, 0x8B717B15, 0xB88E8E26, 0xEC8E9173, 0xDF716440},
    {0x00000000, 0x891D5FB2, 0xC94BB925, 0x4056E697, 0x49E6740B, 0xC0FB2BB9, 0x80ADCD2E, 0x09B0929C, 0x93CCE816,
     0x1AD1B7A4, 0x5A875133, 0xD39A0E81, 0xDA2A9C1D, 0x5337C3AF, 0x13612538, 0x9A7C7A8A},
    {0x00000000, 0xFCE8D66D, 0x22A0AA9B, 0xDE487CF6, 0x45415536, 0xB9A9835B, 0x67E1FFAD, 0x9B0929C0, 0x8A82AA6C,
     0x766A7C01, 0xA82200F7, 0x54CAD69A, 0xCFC3FF5A, 0x332B2937, 0xED6355C1, 0x118B83AC},
    {0x00000000, 0xCE745299, 0x4799A373, 0x89EDF1EA, 0x8F3346E6, 0x4147147F, 0xC8AAE595, 0x06DEB70C, 0xC5178B8D,
     0x0B63D914, 0x828E28FE, 0x4CFA7A67, 0x4A24CD6B, 0x84509FF2, 0x0DBD6E18, 0xC3C93C81},
    {0x00000000, 0x515E115B, 0xA2BC22B6, 0xF3E233ED, 0x9E09432D, 0xCF575276, 0x3CB5619B, 0x6DEB70C0, 0xE763801B,
     0xB63D9140, 0x45DFA2AD, 0x1481B3F6, 0x796AC336, 0x2834D26D, 0xDBD6E180, 0x8A88F0DB},
    {0x00000000, 0x15B60677, 0x2B6C0CEE, 0x3EDA0A99, 0x56D819DC, 0x436E1FAB, 0x7DB41532, 0x68021345, 0xADB033B8,
     0xB80635CF, 0x86DC3F56, 0x936A3921, 0xFB682A64, 0xEEDE2C13, 0xD004268A, 0xC5B220FD},
    {0x00000000, 0x80116131, 0xDB53C423, 0x5B42A512, 0x6DD68E07, 0xEDC7EF36, 0xB6854A24, 0x36942B15, 0xDBAD1C0E,
     0x5BBC7D3F, 0x00FED82D, 0x80EFB91C, 0xB67B9209, 0x366AF338, 0x6D28562A, 0xED39371B},
    {0x00000000, 0x6C2B3E5D, 0xD8567CBA, 0xB47D42E7, 0x6BDDFF35, 0x07F6C168, 0xB38B838F, 0xDFA0BDD2, 0xD7BBFE6A,
     0xBB90C037, 0x0FED82D0, 0x63C6BC8D, 0xBC66015F, 0xD04D3F02, 0x64307DE5, 0x081B43B8}};

static uint32_t append_segment(uint32_t crc, uint32_t segment_crc)
{
    for (unsigned nibble = 0; nibble < 8; nibble++) {
        segment_crc ^= after_segment[nibble][crc >> 4 * nibble & 15U];
    }
    return segment_crc;
}

/* The same for a part of a segment: the CRC's own steps over zero bytes. Its two exclusive-ors with ones, which el_crc32
 * has and a shift has not, are undone around it. */
static uint32_t append_part(uint32_t crc, uint32_t part_crc, size_t bytes)
{
    static const uint8_t zeros[SEGMENT_BYTES];
    return ~el_crc32(~crc, zeros, bytes) ^ part_crc;
}

uint32_t el_changes_find(const uint16_t *pixels, uint32_t width, uint32_t segment, const uint32_t *crcs,
                         uint32_t *fresh)
{
    uint32_t changed = 0;
    for (uint32_t x = 0, i = 0; x < width; x += segment, i++) {
        fresh[i] = el_crc32(0, pixels + x, 2 * (size_t)(width - x < segment ? width - x : segment));
        changed |= (fresh[i] != crcs[i] ? 1U : 0U) << i;
    }
    return changed;
}

uint32_t el_changes_line_crc(const uint32_t *crcs, uint32_t width, uint32_t segment)
{
    uint32_t line_crc = crcs[0];
    for (uint32_t x = segment, i = 1; x < width; x += segment, i++) {
        const size_t bytes = 2 * (size_t)(width - x);
        line_crc = bytes < SEGMENT_BYTES ? append_part(line_crc, crcs[i], bytes) : append_segment(line_crc, crcs[i]);
    }
    return line_crc;
}

uint32_t el_changes_digest(uint32_t digest, uint32_t line_crc)
{
    const uint32_t mixed = line_crc * 0x9E3779B1U;
    return el_crc32(digest, &mixed, sizeof mixed);
}
