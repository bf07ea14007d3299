/* Packets: type, seq, body and CRC-32 inside COBS, as WIRE.md has them.
 *
 *     wire    = *( COBS( packet ) 00 )
 *     packet  = type u8 | seq u8 | body | crc u32, little-endian
 *
 * The writer takes a packet's body in pieces and needs no buffer of the packet's size: each piece goes through the CRC
 * into the COBS queue, and a full queue is emptied into the link by `drain`. The reader does no I/O: bytes in, packets
 * out, in a bounded buffer, because all packets that a host sends are short. */
#ifndef EL_STREAM_PACKET_H
#define EL_STREAM_PACKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/cobs.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EL_PACKET_HELLO = 0x01,
    EL_PACKET_START = 0x02,
    EL_PACKET_BAND = 0x03,
    EL_PACKET_FRAME_END = 0x04,
    EL_PACKET_ACK = 0x05,
    EL_PACKET_KEY = 0x06,
    EL_PACKET_PING = 0x07,
    EL_PACKET_STOP = 0x08,
    EL_PACKET_LOG = 0x09,
    EL_PACKET_INPUT = 0x0A,
    EL_PACKET_SET_BAUD = 0x0B,
    EL_PACKET_BAUD = 0x0C
};

enum {
    EL_PACKET_OVERHEAD_BYTES = 6, /* type, seq, CRC */
    EL_PACKET_HOST_BYTES = 64     /* the largest packet from a host, before COBS; START, the longest, has 12 */
};

/* Results of el_packet_feed and el_packet_end. */
enum {
    EL_PACKET_NONE = 0,
    EL_PACKET_COMPLETE = 1,
    EL_PACKET_DAMAGED = -1, /* what the 00 ended is no packet */
    EL_PACKET_LOST = -2     /* the link took no more of this packet */
};

/* Private but for `wire`, whose final bytes are the link's. */
typedef struct el_packet_writer {
    el_cobs_encoder wire;
    bool (*drain)(void *context);
    void *context;
    uint32_t crc;
    uint32_t begin; /* position of the packet's first byte on the wire */
    uint8_t seq;    /* of the next packet */
    bool torn;      /* a receiver may have part of a packet, or of something else */
    bool lost;      /* `drain` failed within this packet */
} el_packet_writer;

/* `buffer` is the wire queue, EL_COBS_ENCODER_MIN_BYTES at least. `drain(context)` has all final bytes of `wire` taken
 * and returns true, or discards `wire` and returns false. The first packet has a 00 in front of it. */
void el_packet_writer_init(el_packet_writer *writer, uint8_t *buffer, uint16_t capacity, bool (*drain)(void *context),
                           void *context);

/* True if a packet with this many bytes of body goes into the queue without `drain`. */
bool el_packet_fits(const el_packet_writer *writer, size_t body_bytes);

/* One packet: begin, any number of put, end. After a failure of `drain` the rest of the packet is swallowed, and
 * el_packet_end returns EL_PACKET_LOST; else it returns the packet's bytes on the wire, the 00 included. */
void el_packet_begin(el_packet_writer *writer, uint8_t type);
void el_packet_put(el_packet_writer *writer, const void *bytes, size_t count);
void el_packet_put_u8(el_packet_writer *writer, uint8_t value);
void el_packet_put_u16(el_packet_writer *writer, uint16_t value);
void el_packet_put_u32(el_packet_writer *writer, uint32_t value);
int32_t el_packet_end(el_packet_writer *writer);

/* Forgets everything that the link has not taken; the next packet has a 00 in front of it. */
void el_packet_tear(el_packet_writer *writer);

typedef struct el_packet {
    const uint8_t *body; /* inside the reader; valid until its next byte */
    size_t body_bytes;
    uint8_t type;
    uint8_t seq;
} el_packet;

/* Private. All zero is a reader that has seen nothing. */
typedef struct el_packet_reader {
    uint8_t bytes[EL_COBS_MAX_BYTES(EL_PACKET_HOST_BYTES)];
    uint8_t count;
    bool overflow; /* the chunk is longer than `bytes`: no packet for this reader */
} el_packet_reader;

/* Takes one byte. EL_PACKET_COMPLETE: it ended `*packet`. EL_PACKET_DAMAGED: it ended a chunk that is no COBS, shorter
 * than 6 bytes, longer than EL_PACKET_HOST_BYTES or has a wrong CRC. EL_PACKET_NONE otherwise. */
int el_packet_feed(el_packet_reader *reader, uint8_t byte, el_packet *packet);

/* Little-endian values at any address. */
uint16_t el_packet_get_u16(const uint8_t *bytes);
uint32_t el_packet_get_u32(const uint8_t *bytes);

#ifdef __cplusplus
}
#endif

#endif
