/* The packet layer: one writer that streams, one reader that collects. */
#include "stream/packet.h"

#include "base/crc32.h"

void el_packet_writer_init(el_packet_writer *writer, uint8_t *buffer, uint16_t capacity, bool (*drain)(void *context),
                           void *context)
{
    *writer = (el_packet_writer){.drain = drain, .context = context, .torn = true};
    el_cobs_init(&writer->wire, buffer, capacity);
}

bool el_packet_fits(const el_packet_writer *writer, size_t body_bytes)
{
    return el_cobs_room(&writer->wire) >= body_bytes + EL_PACKET_OVERHEAD_BYTES;
}

/* Puts bytes on the wire that the CRC does not see. */
static void put_plain(el_packet_writer *writer, const void *bytes, size_t count)
{
    const uint8_t *from = bytes;

    while (!writer->lost) {
        size_t put = el_cobs_put(&writer->wire, from, count);
        from += put;
        count -= put;
        if (count == 0) {
            break;
        }
        writer->lost = !writer->drain(writer->context);
    }
}

void el_packet_begin(el_packet_writer *writer, uint8_t type)
{
    writer->lost = el_cobs_room(&writer->wire) == 0 && !writer->drain(writer->context);
    writer->crc = 0;
    if (!writer->lost) {
        if (writer->torn) {
            el_cobs_delimit(&writer->wire);
            writer->torn = false;
        }
        writer->begin = el_cobs_position(&writer->wire);
        el_cobs_begin(&writer->wire);
    }
    el_packet_put_u8(writer, type);
    el_packet_put_u8(writer, writer->seq++);
}

void el_packet_put(el_packet_writer *writer, const void *bytes, size_t count)
{
    writer->crc = el_crc32(writer->crc, bytes, count);
    put_plain(writer, bytes, count);
}

void el_packet_put_u8(el_packet_writer *writer, uint8_t value)
{
    el_packet_put(writer, &value, 1);
}

void el_packet_put_u16(el_packet_writer *writer, uint16_t value)
{
    uint8_t bytes[2] = {(uint8_t)value, (uint8_t)(value >> 8)};
    el_packet_put(writer, bytes, sizeof bytes);
}

void el_packet_put_u32(el_packet_writer *writer, uint32_t value)
{
    uint8_t bytes[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24)};
    el_packet_put(writer, bytes, sizeof bytes);
}

int32_t el_packet_end(el_packet_writer *writer)
{
    el_packet_put_u32(writer, writer->crc);
    if (writer->lost) {
        return EL_PACKET_LOST;
    }
    el_cobs_end(&writer->wire);
    return (int32_t)(el_cobs_position(&writer->wire) - writer->begin);
}

void el_packet_tear(el_packet_writer *writer)
{
    el_cobs_discard(&writer->wire);
    writer->torn = true;
}

static int parse(uint8_t *bytes, size_t count, el_packet *packet)
{
    int32_t size = el_cobs_decode(bytes, count);
    if (size < EL_PACKET_OVERHEAD_BYTES) {
        return EL_PACKET_DAMAGED;
    }
    size_t crc_at = (size_t)size - 4;
    if (el_crc32(0, bytes, crc_at) != el_packet_get_u32(bytes + crc_at)) {
        return EL_PACKET_DAMAGED;
    }
    *packet = (el_packet){.body = bytes + 2, .body_bytes = crc_at - 2, .type = bytes[0], .seq = bytes[1]};
    return EL_PACKET_COMPLETE;
}

int el_packet_feed(el_packet_reader *reader, uint8_t byte, el_packet *packet)
{
    if (byte != 0) {
        if (reader->count == sizeof reader->bytes) {
            reader->overflow = true;
        } else {
            reader->bytes[reader->count++] = byte;
        }
        return EL_PACKET_NONE;
    }

    size_t count = reader->count;
    bool overflow = reader->overflow;
    reader->count = 0;
    reader->overflow = false;
    if (overflow) {
        return EL_PACKET_DAMAGED;
    }
    return count == 0 ? EL_PACKET_NONE : parse(reader->bytes, count, packet);
}

uint16_t el_packet_get_u16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

uint32_t el_packet_get_u32(const uint8_t *bytes)
{
    return el_packet_get_u16(bytes) | (uint32_t)el_packet_get_u16(bytes + 2) << 16;
}
