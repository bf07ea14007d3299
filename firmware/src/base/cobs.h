/* Consistent overhead byte stuffing: packets without a 00 byte, so that 00 can end them.
 *
 * Cheshire and Baker, "Consistent overhead byte stuffing", IEEE/ACM Transactions on Networking 7(2), 1999. A packet is
 * cut into blocks; each block is a code byte and code-1 bytes that are not 00:
 *
 *     code 01..FE   the block's bytes, then a 00 that is not sent (after the packet's last block: none)
 *     code FF       254 bytes and no 00
 *
 * The encoding here is the shortest: a packet that ends with a full block has no empty one after it. The decoder takes
 * both.
 *
 * The encoder is a queue: packet bytes go in at one end, wire bytes are taken from the other. A block's code byte is
 * known only at its end, hence up to 255 bytes stay back; all before them are final. So a packet of any size goes out
 * through a buffer of a fixed size. */
#ifndef EL_BASE_COBS_H
#define EL_BASE_COBS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes that `count` bytes take when encoded, at most; the 00 behind them not counted. */
#define EL_COBS_MAX_BYTES(count) ((count) == 0 ? 1 : (count) + ((count) + 253) / 254)

enum {
    EL_COBS_ZERO = -1, /* a 00 inside an encoding */
    EL_COBS_CUT = -2,  /* no byte at all, or a block that is longer than what is left */

    /* The smallest buffer of an encoder: an open block, the two bytes that one more byte can cost, and the final 00. */
    EL_COBS_ENCODER_MIN_BYTES = 255 + 2 + 1
};

/* Decodes `count` bytes in place and returns the size of the result, which is smaller, or EL_COBS_ZERO or EL_COBS_CUT,
 * whichever comes first; then the bytes are spoilt. `count` excludes the 00 that ended the encoding. */
int32_t el_cobs_decode(uint8_t *bytes, size_t count);

/* Private; 0 <= taken <= code_at <= used <= capacity. Between packets code_at == used. */
typedef struct el_cobs_encoder {
    uint8_t *bytes;
    uint16_t capacity;
    uint16_t taken;   /* bytes in front that the link has */
    uint16_t code_at; /* where the open block begins */
    uint16_t used;
    uint32_t moved; /* bytes that have left the buffer, modulo 2^32 */
} el_cobs_encoder;

/* An empty queue in `bytes`, which stays the caller's and must outlive the encoder.
 * EL_COBS_ENCODER_MIN_BYTES <= capacity <= 65535. */
void el_cobs_init(el_cobs_encoder *encoder, uint8_t *bytes, uint16_t capacity);

/* Packet bytes that surely fit now, the packet's beginning and end paid for. */
size_t el_cobs_room(const el_cobs_encoder *encoder);

/* Begins a packet. Between packets only, with el_cobs_room() > 0. */
void el_cobs_begin(el_cobs_encoder *encoder);

/* Adds up to `count` bytes to the packet and returns how many; fewer than `count` means that the queue is full. When
 * all final bytes have been taken, at least one more fits. */
size_t el_cobs_put(el_cobs_encoder *encoder, const void *bytes, size_t count);

/* Ends the packet with its 00. There is always room for that. */
void el_cobs_end(el_cobs_encoder *encoder);

/* Adds a 00 between packets, which ends what a receiver may have of a broken one. Only with el_cobs_room() > 0. */
void el_cobs_delimit(el_cobs_encoder *encoder);

/* The final bytes that have not been taken, `*count` of them; valid until the next call on this encoder. */
const uint8_t *el_cobs_final(const el_cobs_encoder *encoder, size_t *count);

/* Takes the first `count` of the final bytes off the queue. */
void el_cobs_take(el_cobs_encoder *encoder, size_t count);

/* Empties the queue; a packet that was begun is lost. */
void el_cobs_discard(el_cobs_encoder *encoder);

/* Wire bytes made so far, modulo 2^32: the difference of two positions between packets is the size of what lies
 * between them. */
uint32_t el_cobs_position(const el_cobs_encoder *encoder);

#ifdef __cplusplus
}
#endif

#endif
