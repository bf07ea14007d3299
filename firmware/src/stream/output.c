/* What leaves: the queue to the port, waiting for the link but never for ever, and the packets that are sent between two
 * others. */
#include "stream/parts.h"

enum {
    PIXEL_FORMAT_RGB565 = 1,
    HELLO_FIXED_BYTES = 28 + 2 + 12, /* the two length bytes included, and what is behind the names */
    HELLO_MAX_BYTES = HELLO_FIXED_BYTES + 2 * EL_STREAM_MAX_NAME_BYTES,
    BAUD_BYTES = 4,
    EMPTY_QUEUE_COST =
        2 + 2 + 1 /* 00s around a packet of up to 254 bytes, its code byte, and what el_cobs_room spares */
};

_Static_assert(EL_COBS_ENCODER_MIN_BYTES >= HELLO_MAX_BYTES + EL_PACKET_OVERHEAD_BYTES + EMPTY_QUEUE_COST,
               "HELLO is sent without waiting: it must fit into an empty queue");
_Static_assert(EL_COBS_ENCODER_MIN_BYTES >= EL_STREAM_MAX_LOG_BYTES + EL_PACKET_OVERHEAD_BYTES + EMPTY_QUEUE_COST,
               "so is LOG");
_Static_assert(EL_STREAM_PACKET_BYTES(EL_STREAM_MAX_SIZE) <= UINT16_MAX, "HELLO states it in 16 bits");

/* The link takes too little. What is said about it waits in the queue until it takes something again. */
static void give_up(el_stream *stream)
{
    el_packet_tear(&stream->writer);
    stream->stalls++;
    stream->notice = "the link stalled: what was on its way was given up";
    if (stream->config.one_way) {
        stream->frame.sending = false;
        stream->stalled = true;
        stream->hello_due = true;
    } else {
        el_stream_wait_for_start(stream);
    }
}

void el_stream_lose_link(el_stream *stream)
{
    el_packet_tear(&stream->writer);
    stream->state = EL_STREAM_GONE;
    stream->frame.sending = false;
}

/* --- The queue ---------------------------------------------------------------------------------------------------- */

bool el_stream_push(el_stream *stream)
{
    const el_port *port = stream->config.port;
    size_t count;
    const uint8_t *bytes = el_cobs_final(&stream->writer.wire, &count);

    if (stream->state != EL_STREAM_GONE && count > 0) {
        int32_t took = port->write(port->context, bytes, count);
        if (took < 0) {
            el_stream_lose_link(stream);
        } else {
            el_cobs_take(&stream->writer.wire, (size_t)took);
        }
    }
    return stream->state != EL_STREAM_GONE;
}

size_t el_stream_unsent(const el_stream *stream)
{
    size_t count;
    (void)el_cobs_final(&stream->writer.wire, &count);
    return count;
}

bool el_stream_fits(const el_stream *stream, size_t body_bytes)
{
    const bool reserved = stream->frame.sending && stream->rolling;
    return el_packet_fits(&stream->writer, body_bytes + (reserved ? (size_t)EL_STREAM_RESERVE_BYTES : 0));
}

/* The bytes first: time must be able to use up all that they earn, or a byte now and then would do for ever. */
static void spend_patience(el_stream *stream, uint32_t us, size_t bytes_taken)
{
    uint32_t earned = EL_STREAM_BYTE_US * (uint32_t)bytes_taken; /* a queue's worth, below 2^27 */
    uint32_t patience = stream->patience_us + earned;

    patience = patience < EL_STREAM_PATIENCE_US ? patience : EL_STREAM_PATIENCE_US;
    stream->patience_us = patience > us ? patience - us : 0;
}

/* Waits until the port has taken everything, or as long as there is patience. */
bool el_stream_drain(void *context)
{
    el_stream *stream = context;
    const el_port *port = stream->config.port;
    uint32_t last_us = el_stream_now_us(stream);
    size_t left = el_stream_unsent(stream);

    while (left > 0 && el_stream_push(stream)) {
        size_t took = left - el_stream_unsent(stream);
        uint32_t now = el_stream_now_us(stream);
        spend_patience(stream, now - last_us, took);
        last_us = now;
        left -= took;
        if (took > 0 && stream->patience_us > 0) {
            continue;
        }
        el_stream_receive(stream);
        if (stream->state != EL_STREAM_GONE && left > 0 && stream->patience_us == 0) {
            give_up(stream);
            return false;
        }
        if (port->wait != NULL) {
            port->wait(port->context);
        }
    }
    return stream->state != EL_STREAM_GONE;
}

bool el_stream_flush(el_stream *stream)
{
    if (!stream->frame.sending) {
        stream->patience_us = EL_STREAM_PATIENCE_US;
    }
    return el_stream_drain(stream);
}

/* --- HELLO, BAUD and LOG ------------------------------------------------------------------------------------------ */

/* strlen, which a freestanding board need not have; EL_STREAM_MAX_LOG_BYTES at most. */
static size_t text_bytes(const char *text)
{
    size_t count = 0;
    while (count < EL_STREAM_MAX_LOG_BYTES && text[count] != '\0') {
        count++;
    }
    return count;
}

static void put_name(el_packet_writer *writer, const char *name)
{
    size_t bytes = text_bytes(name);
    el_packet_put_u8(writer, (uint8_t)bytes);
    el_packet_put(writer, name, bytes);
}

static uint32_t capabilities(const el_stream *stream)
{
    if (stream->config.one_way) {
        return EL_STREAM_OLD_CODECS;
    }
    return EL_STREAM_CODECS | EL_STREAM_PARTIAL | (stream->config.input != NULL ? EL_STREAM_INPUT : 0U) |
           (el_stream_knows_roll(stream) ? EL_STREAM_ROLL : 0U) |
           (el_stream_has_rates(stream) ? EL_STREAM_SET_BAUD : 0U);
}

static void send_hello(el_stream *stream)
{
    const el_stream_config *config = &stream->config;
    el_packet_writer *writer = &stream->writer;

    el_packet_begin(writer, EL_PACKET_HELLO);
    el_packet_put(writer, "EDGL", 4);
    el_packet_put_u8(writer, EL_STREAM_PROTOCOL_MAJOR);
    el_packet_put_u8(writer, EL_STREAM_PROTOCOL_MINOR);
    el_packet_put_u16(writer, config->width);
    el_packet_put_u16(writer, config->height);
    el_packet_put_u8(writer, PIXEL_FORMAT_RGB565);
    el_packet_put_u8(writer, 0);
    el_packet_put_u16(writer, stream->segment < config->width ? stream->segment : 0);
    el_packet_put_u16(writer, (uint16_t)EL_STREAM_PACKET_BYTES(config->width));
    el_packet_put_u32(writer, capabilities(stream));
    el_packet_put_u32(writer, config->max_baud);
    el_packet_put_u32(writer, config->boot_id);
    put_name(writer, config->target);
    put_name(writer, config->firmware);
    el_packet_put_u8(writer, stream->input_number);
    el_packet_put_u8(writer, config->scenes);
    el_packet_put_u32(writer, config->controls);
    el_packet_put_u16(writer, config->views);
    el_packet_put_u32(writer, stream->rate.now);
    el_packet_end(writer);
}

static void send_log(el_stream *stream, const char *text, size_t count)
{
    el_packet_begin(&stream->writer, EL_PACKET_LOG);
    el_packet_put(&stream->writer, text, count);
    el_packet_end(&stream->writer);
}

/* LOG for a host whose major version is another one. */
static void send_refusal(el_stream *stream)
{
    static const char text[] = "this device has version 1 of the wire and takes nothing from a host of version ";
    enum { TEXT_BYTES = sizeof text - 1 };
    _Static_assert(EL_STREAM_PROTOCOL_MAJOR == 1 && TEXT_BYTES + 3 <= EL_STREAM_MAX_LOG_BYTES, "as the text says");
    const uint8_t major = stream->host_major;
    el_packet_writer *writer = &stream->writer;

    el_packet_begin(writer, EL_PACKET_LOG);
    el_packet_put(writer, text, TEXT_BYTES);
    for (uint8_t place = major < 10 ? 1 : major < 100 ? 10 : 100; place > 0; place = (uint8_t)(place / 10)) {
        el_packet_put_u8(writer, (uint8_t)('0' + major / place % 10));
    }
    el_packet_end(writer);
}

static void send_baud(el_stream *stream)
{
    el_packet_begin(&stream->writer, EL_PACKET_BAUD);
    el_packet_put_u32(&stream->writer, stream->rate.next);
    el_packet_end(&stream->writer);
    stream->rate.answer_due = false;
    stream->rate.changing = stream->rate.next != stream->rate.now;
}

void el_stream_send_pending(el_stream *stream)
{
    bool nobody = stream->state == EL_STREAM_WAITING || stream->config.one_way;
    uint32_t now = el_stream_now_us(stream);

    if (stream->rate.changing) {
        return;
    }
    if (nobody && now - stream->hello_us >= EL_STREAM_PATIENCE_US) {
        stream->hello_us = now;
        stream->hello_due = true;
    }
    if (stream->hello_due && el_stream_fits(stream, HELLO_MAX_BYTES)) {
        stream->hello_due = false;
        send_hello(stream);
    }
    if (stream->refusal_due && el_stream_fits(stream, EL_STREAM_MAX_LOG_BYTES)) {
        stream->refusal_due = false;
        send_refusal(stream);
    }
    if (stream->notice != NULL && el_stream_fits(stream, text_bytes(stream->notice))) {
        send_log(stream, stream->notice, text_bytes(stream->notice));
        stream->notice = NULL;
    }
    if (stream->rate.answer_due && el_stream_fits(stream, BAUD_BYTES)) {
        send_baud(stream);
    }
}

int32_t el_stream_log(el_stream *stream, const char *text, size_t count)
{
    if (count > EL_STREAM_MAX_LOG_BYTES) {
        count = EL_STREAM_MAX_LOG_BYTES;
        while (count > 0 && ((uint8_t)text[count] & 0xC0) == 0x80) { /* inside a UTF-8 character */
            count--;
        }
    }
    if (!el_stream_fits(stream, count) && stream->state == EL_STREAM_RUNNING && !stream->rolling) {
        el_stream_flush(stream);
    }
    if (stream->state == EL_STREAM_GONE) {
        return EL_STREAM_LINK_GONE;
    }
    if (stream->rate.changing || !el_stream_fits(stream, count)) {
        return 0;
    }
    send_log(stream, text, count);
    return el_stream_push(stream) ? (int32_t)count : EL_STREAM_LINK_GONE;
}
