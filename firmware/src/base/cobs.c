/* COBS, byte by byte: the routine that runs on the device is also the plain one. A block that is full is closed only
 * when another byte follows, which is what makes the encoding the shortest. */
#include "base/cobs.h"

#include <string.h>

enum { FULL_BLOCK = 255 }; /* a block's largest size, its code byte included, and that code */

int32_t el_cobs_decode(uint8_t *bytes, size_t count)
{
    size_t in = 0;
    size_t out = 0;

    if (count == 0) {
        return EL_COBS_CUT;
    }
    while (in < count) {
        size_t code = bytes[in++];
        if (code == 0) {
            return EL_COBS_ZERO;
        }
        if (count - in < code - 1) {
            return EL_COBS_CUT;
        }
        for (size_t i = 1; i < code; i++) {
            if (bytes[in] == 0) {
                return EL_COBS_ZERO;
            }
            bytes[out++] = bytes[in++];
        }
        if (code < FULL_BLOCK && in < count) {
            bytes[out++] = 0;
        }
    }
    return (int32_t)out;
}

void el_cobs_init(el_cobs_encoder *encoder, uint8_t *bytes, uint16_t capacity)
{
    *encoder = (el_cobs_encoder){.bytes = bytes, .capacity = capacity};
}

/* A byte costs itself, or as a 00 the code byte of the block that it opens; the first may find a full block and cost one
 * more, and so may each 254th after it. So n bytes cost at most n + 1 + (n - 1) / 254. One is kept for the final 00. */
static size_t room_behind(const el_cobs_encoder *encoder, size_t used)
{
    size_t left = encoder->capacity - used;
    return left < 3 ? 0 : left - 2 - left / 254;
}

size_t el_cobs_room(const el_cobs_encoder *encoder)
{
    /* In front of a packet: a 00 of el_cobs_delimit and the first code byte. */
    size_t used = (size_t)(encoder->used - encoder->taken) + 2;
    return used < encoder->capacity ? room_behind(encoder, used) : 0;
}

/* Moves what is left to the front of the buffer. */
static void compact(el_cobs_encoder *encoder)
{
    uint16_t taken = encoder->taken;

    memmove(encoder->bytes, encoder->bytes + taken, (size_t)(encoder->used - taken));
    encoder->moved += taken;
    encoder->used = (uint16_t)(encoder->used - taken);
    encoder->code_at = (uint16_t)(encoder->code_at - taken);
    encoder->taken = 0;
}

static void open_block(el_cobs_encoder *encoder)
{
    encoder->code_at = encoder->used++;
}

static void close_block(el_cobs_encoder *encoder)
{
    encoder->bytes[encoder->code_at] = (uint8_t)(encoder->used - encoder->code_at);
}

void el_cobs_begin(el_cobs_encoder *encoder)
{
    compact(encoder);
    open_block(encoder);
}

size_t el_cobs_put(el_cobs_encoder *encoder, const void *bytes, size_t count)
{
    const uint8_t *from = bytes;
    size_t room = room_behind(encoder, encoder->used);

    if (room < count && encoder->taken > 0) {
        compact(encoder);
        room = room_behind(encoder, encoder->used);
    }
    if (count > room) {
        count = room;
    }
    for (size_t i = 0; i < count; i++) {
        if (encoder->used - encoder->code_at == FULL_BLOCK) {
            close_block(encoder);
            open_block(encoder);
        }
        if (from[i] == 0) {
            close_block(encoder);
            open_block(encoder);
        } else {
            encoder->bytes[encoder->used++] = from[i];
        }
    }
    return count;
}

void el_cobs_end(el_cobs_encoder *encoder)
{
    close_block(encoder);
    encoder->bytes[encoder->used++] = 0;
    encoder->code_at = encoder->used;
}

void el_cobs_delimit(el_cobs_encoder *encoder)
{
    compact(encoder);
    encoder->bytes[encoder->used++] = 0;
    encoder->code_at = encoder->used;
}

const uint8_t *el_cobs_final(const el_cobs_encoder *encoder, size_t *count)
{
    *count = (size_t)(encoder->code_at - encoder->taken);
    return encoder->bytes + encoder->taken;
}

void el_cobs_take(el_cobs_encoder *encoder, size_t count)
{
    encoder->taken = (uint16_t)(encoder->taken + count);
}

void el_cobs_discard(el_cobs_encoder *encoder)
{
    encoder->moved += encoder->used;
    encoder->taken = 0;
    encoder->code_at = 0;
    encoder->used = 0;
}

uint32_t el_cobs_position(const el_cobs_encoder *encoder)
{
    return encoder->moved + encoder->used;
}
