/* The session: input packets change the state, output waits for the link but never for ever.
 *
 * Input may arrive in the middle of an outgoing packet, while that waits for room. Whatever needs an answer is
 * therefore only noted (hello_due, notice) and sent by el_stream_poll, between two packets. */
#include "stream/session.h"

#include <string.h>

enum {
    MODE_BLOCK = 0,
    PIXEL_FORMAT_RGB565 = 1,
    PROTOCOL_MAJOR = 1,
    PROTOCOL_MINOR = 2,
    OLD_CODECS = EL_STREAM_RAW | EL_STREAM_RUNS, /* what every host knows */
    CODECS = OLD_CODECS | (EL_STREAM_WITH_SPLIT ? EL_STREAM_SPLIT : 0),
    HELLO_FIXED_BYTES = 28 + 2, /* the two length bytes included */
    HELLO_MAX_BYTES = HELLO_FIXED_BYTES + 2 * EL_STREAM_MAX_NAME_BYTES,
    START_BYTES = 6,
    ACK_BYTES = 3,
    KEY_BYTES = 4,
    INPUT_BYTES = 5,
    MAX_CREDITS = 255,
    EMPTY_QUEUE_COST =
        2 + 2 + 1, /* 00s around a packet of up to 254 bytes, its code byte, and what el_cobs_room spares */
    READ_BYTES = 32,
    READS_PER_POLL = 8 /* a host that floods the link does not stop the device */
};

_Static_assert(EL_STREAM_WIRE_BYTES >= (int)EL_COBS_ENCODER_MIN_BYTES, "the queue must hold an open block");
_Static_assert(EL_STREAM_WIRE_BYTES <= UINT16_MAX, "the queue counts in 16 bits");
_Static_assert(EL_COBS_ENCODER_MIN_BYTES >= HELLO_MAX_BYTES + EL_PACKET_OVERHEAD_BYTES + EMPTY_QUEUE_COST,
               "HELLO is sent without waiting: it must fit into an empty queue");
_Static_assert(EL_COBS_ENCODER_MIN_BYTES >= EL_STREAM_MAX_LOG_BYTES + EL_PACKET_OVERHEAD_BYTES + EMPTY_QUEUE_COST,
               "so is LOG");
_Static_assert(EL_STREAM_PACKET_BYTES(EL_STREAM_MAX_SIZE) <= UINT16_MAX, "HELLO states it in 16 bits");

static uint32_t now_us(const el_stream *stream)
{
    return stream->config.port->micros(stream->config.port->context);
}

/* --- Ends of a session -------------------------------------------------------------------------------------------- */

static void lose_link(el_stream *stream)
{
    el_packet_tear(&stream->writer);
    stream->state = EL_STREAM_GONE;
    stream->frame.sending = false;
}

/* The host is gone or has not come yet. */
static void wait_for_start(el_stream *stream)
{
    stream->frame.sending = false;
    stream->state = EL_STREAM_WAITING;
    stream->credits = 0;
    stream->hello_us = now_us(stream);
}

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
        wait_for_start(stream);
    }
}

/* --- Input -------------------------------------------------------------------------------------------------------- */

void el_stream_make_due(el_stream *stream, uint32_t y0, uint32_t y1)
{
    for (uint32_t y = y0; y < y1; y++) {
        stream->lines_due[y / 8] = (uint8_t)(stream->lines_due[y / 8] | 1U << y % 8);
    }
}

static void take_start(el_stream *stream, const uint8_t *body)
{
    uint16_t frames_per_s = el_packet_get_u16(body + 2);
    uint16_t codecs = el_packet_get_u16(body + 4) & CODECS;

    if (body[0] != MODE_BLOCK) {
        stream->notice = "START refused: this device knows mode 0 (BLOCK) only";
        return;
    }
    if (codecs == 0) {
        stream->notice = "START refused: it names no codec that this device sends";
        return;
    }
    stream->state = EL_STREAM_RUNNING;
    stream->frame.sending = false;
    stream->credits = body[1];
    stream->codecs = codecs;
    stream->asked = true;
    stream->dropped = 0;
    stream->period_us = frames_per_s == 0 ? 0 : 1000000U / frames_per_s;
    stream->frame_us = now_us(stream) - stream->period_us; /* the first frame is due at once */
    el_stream_make_due(stream, 0, stream->config.height);
}

static void take_ack(el_stream *stream, const uint8_t *body)
{
    uint32_t credits = (uint32_t)stream->credits + body[2];
    stream->credits = (uint8_t)(credits < MAX_CREDITS ? credits : MAX_CREDITS); /* START sets them anew */
}

static void take_key(el_stream *stream, const uint8_t *body)
{
    uint32_t y0 = el_packet_get_u16(body);
    uint32_t y1 = y0 + el_packet_get_u16(body + 2);
    uint32_t height = stream->config.height;
    el_stream_make_due(stream, y0, y1 < height ? y1 : height);
    stream->asked = true;
}

static void take_input(el_stream *stream, const uint8_t *body)
{
    const el_stream_config *config = &stream->config;
    uint32_t value = el_packet_get_u16(body + 1) | (uint32_t)el_packet_get_u16(body + 3) << 16;

    if (config->input != NULL) {
        stream->input_came = true;
        config->input(config->input_context, body[0], (int32_t)value);
    }
}

static void take_packet(el_stream *stream, const el_packet *packet)
{
    static const struct {
        uint8_t type;
        uint8_t body_bytes;
    } shortest[] = {{EL_PACKET_START, START_BYTES},
                    {EL_PACKET_ACK, ACK_BYTES},
                    {EL_PACKET_KEY, KEY_BYTES},
                    {EL_PACKET_INPUT, INPUT_BYTES}};

    for (size_t i = 0; i < sizeof shortest / sizeof shortest[0]; i++) {
        if (packet->type == shortest[i].type && packet->body_bytes < shortest[i].body_bytes) {
            stream->damaged++;
            return;
        }
    }
    stream->heard_us = now_us(stream);
    switch (packet->type) {
    case EL_PACKET_START:
        take_start(stream, packet->body);
        break;
    case EL_PACKET_ACK:
        take_ack(stream, packet->body);
        break;
    case EL_PACKET_KEY:
        take_key(stream, packet->body);
        break;
    case EL_PACKET_INPUT:
        take_input(stream, packet->body);
        break;
    case EL_PACKET_PING:
        stream->hello_due = true;
        break;
    case EL_PACKET_STOP:
        wait_for_start(stream);
        break;
    default: /* a later version's */
        break;
    }
}

static void take_byte(el_stream *stream, uint8_t byte)
{
    el_packet packet;
    int result = el_packet_feed(&stream->reader, byte, &packet);

    if (result == EL_PACKET_DAMAGED) {
        stream->damaged++;
    } else if (result == EL_PACKET_COMPLETE) {
        if (packet.type != EL_PACKET_START && packet.type != EL_PACKET_PING) { /* those may be a new host's first */
            stream->missed += (uint8_t)(packet.seq - stream->next_seq);
        }
        stream->next_seq = (uint8_t)(packet.seq + 1);
        take_packet(stream, &packet);
    }
}

static void receive(el_stream *stream)
{
    const el_port *port = stream->config.port;
    uint8_t bytes[READ_BYTES];
    int32_t count = 1;

    for (int i = 0; i < READS_PER_POLL && count > 0 && !stream->config.one_way; i++) {
        count = port->read(port->context, bytes, sizeof bytes);
        for (int32_t at = 0; at < count; at++) {
            take_byte(stream, bytes[at]);
        }
    }
    if (count < 0) {
        lose_link(stream);
    }
}

/* --- Output ------------------------------------------------------------------------------------------------------- */

bool el_stream_push(el_stream *stream)
{
    const el_port *port = stream->config.port;
    size_t count;
    const uint8_t *bytes = el_cobs_final(&stream->writer.wire, &count);

    if (stream->state != EL_STREAM_GONE && count > 0) {
        int32_t took = port->write(port->context, bytes, count);
        if (took < 0) {
            lose_link(stream);
        } else {
            el_cobs_take(&stream->writer.wire, (size_t)took);
        }
    }
    return stream->state != EL_STREAM_GONE;
}

static size_t bytes_to_push(const el_stream *stream)
{
    size_t count;
    (void)el_cobs_final(&stream->writer.wire, &count);
    return count;
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
static bool drain(void *context)
{
    el_stream *stream = context;
    const el_port *port = stream->config.port;
    uint32_t last_us = now_us(stream);
    size_t left = bytes_to_push(stream);

    while (left > 0 && el_stream_push(stream)) {
        size_t took = left - bytes_to_push(stream);
        uint32_t now = now_us(stream);
        spend_patience(stream, now - last_us, took);
        last_us = now;
        left -= took;
        if (took > 0 && stream->patience_us > 0) {
            continue;
        }
        receive(stream);
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
    return drain(stream);
}

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

static void send_hello(el_stream *stream)
{
    const el_stream_config *config = &stream->config;
    el_packet_writer *writer = &stream->writer;
    uint32_t capabilities = OLD_CODECS;

    if (!config->one_way) {
        capabilities |= CODECS | EL_STREAM_PARTIAL | (config->input != NULL ? EL_STREAM_INPUT : 0U);
    }
    el_packet_begin(writer, EL_PACKET_HELLO);
    el_packet_put(writer, "EDGL", 4);
    el_packet_put_u8(writer, PROTOCOL_MAJOR);
    el_packet_put_u8(writer, PROTOCOL_MINOR);
    el_packet_put_u16(writer, config->width);
    el_packet_put_u16(writer, config->height);
    el_packet_put_u8(writer, PIXEL_FORMAT_RGB565);
    el_packet_put_u8(writer, 0);
    el_packet_put_u16(writer, stream->segment < config->width ? stream->segment : 0);
    el_packet_put_u16(writer, (uint16_t)EL_STREAM_PACKET_BYTES(config->width));
    el_packet_put_u32(writer, capabilities);
    el_packet_put_u32(writer, config->max_baud);
    el_packet_put_u32(writer, config->boot_id);
    put_name(writer, config->target);
    put_name(writer, config->firmware);
    el_packet_end(writer);
}

static void send_log(el_stream *stream, const char *text, size_t count)
{
    el_packet_begin(&stream->writer, EL_PACKET_LOG);
    el_packet_put(&stream->writer, text, count);
    el_packet_end(&stream->writer);
}

/* What waits for a chance between two packets and fits without waiting. */
static void send_pending(el_stream *stream)
{
    bool nobody = stream->state == EL_STREAM_WAITING || stream->config.one_way;
    uint32_t now = now_us(stream);

    if (nobody && now - stream->hello_us >= EL_STREAM_PATIENCE_US) {
        stream->hello_us = now;
        stream->hello_due = true;
    }
    if (stream->hello_due && el_packet_fits(&stream->writer, HELLO_MAX_BYTES)) {
        stream->hello_due = false;
        send_hello(stream);
    }
    if (stream->notice != NULL && el_packet_fits(&stream->writer, text_bytes(stream->notice))) {
        send_log(stream, stream->notice, text_bytes(stream->notice));
        stream->notice = NULL;
    }
}

/* --- The public door ---------------------------------------------------------------------------------------------- */

static bool is_name(const char *name)
{
    return name != NULL && text_bytes(name) <= EL_STREAM_MAX_NAME_BYTES;
}

static size_t memory_needed(const el_stream_config *config)
{
    return EL_STREAM_MEMORY_BYTES(config->width, config->height) +
           (config->segments ? EL_STREAM_SEGMENT_MEMORY_BYTES(config->width, config->height) : 0);
}

static int check(const el_stream_config *config)
{
    const el_port *port = config->port;

    if (config->width < 1 || config->width > EL_STREAM_MAX_SIZE || config->height < 1 ||
        config->height > EL_STREAM_MAX_SIZE) {
        return EL_STREAM_BAD_SIZE;
    }
    if (config->memory == NULL || config->memory_bytes < memory_needed(config)) {
        return EL_STREAM_BAD_MEMORY;
    }
    if (port == NULL || port->write == NULL || port->micros == NULL || (port->read == NULL && !config->one_way)) {
        return EL_STREAM_BAD_PORT;
    }
    return is_name(config->target) && is_name(config->firmware) ? 0 : EL_STREAM_BAD_NAME;
}

/* Gives each part of the memory its place, all zero, the most aligned first. */
static void carve(el_stream *stream, uint8_t *memory)
{
    const el_stream_config *config = &stream->config;
    const bool segments = EL_STREAM_WITH_SPLIT && config->segments && config->width > EL_SPLIT_SEGMENT_PIXELS;
    stream->segment = segments ? (uint16_t)EL_SPLIT_SEGMENT_PIXELS : config->width;
    const size_t crcs = config->height * (((size_t)config->width - 1) / stream->segment + 1);

    memset(memory, 0, memory_needed(config));
    memory += -(uintptr_t)memory & 3;
    stream->crcs = (uint32_t *)(void *)memory;
    memory += 4 * crcs;
#if EL_STREAM_WITH_SPLIT
    stream->last_line = (uint16_t *)(void *)memory;
    memory += 2 * (size_t)config->width;
    el_split_init(&stream->split, memory, config->width);
#endif
    stream->tokens = memory;
    stream->lines_due =
        memory + (EL_STREAM_BUILD_BYTES(config->width) - 2 * (size_t)config->width * EL_STREAM_WITH_SPLIT);
}

int el_stream_init(el_stream *stream, const el_stream_config *config)
{
    int error = check(config);
    if (error != 0) {
        return error;
    }
    memset(stream, 0, sizeof *stream);
    stream->config = *config;

    carve(stream, config->memory);
    el_packet_writer_init(&stream->writer, stream->wire, sizeof stream->wire, drain, stream);
    stream->state = config->one_way ? EL_STREAM_RUNNING : EL_STREAM_WAITING;
    stream->codecs = OLD_CODECS; /* one-way; others say it in START */
    stream->hello_due = true;
    stream->hello_us = now_us(stream);
    return 0;
}

int el_stream_poll(el_stream *stream)
{
    if (stream->state != EL_STREAM_GONE) {
        receive(stream);
    }
    if (stream->state == EL_STREAM_RUNNING && !stream->config.one_way && stream->credits == 0 &&
        now_us(stream) - stream->heard_us >= EL_STREAM_PATIENCE_US) {
        wait_for_start(stream);
    }
    if (stream->state != EL_STREAM_GONE) {
        send_pending(stream);
        el_stream_push(stream);
        stream->stalled = stream->stalled && (stream->hello_due || bytes_to_push(stream) > 0);
    }
    return stream->state == EL_STREAM_GONE ? EL_STREAM_LINK_GONE : 0;
}

bool el_stream_ready(const el_stream *stream)
{
    return stream->state == EL_STREAM_RUNNING && (stream->config.one_way ? !stream->stalled : stream->credits > 0) &&
           (stream->period_us == 0 || now_us(stream) - stream->frame_us >= stream->period_us);
}

int32_t el_stream_log(el_stream *stream, const char *text, size_t count)
{
    if (count > EL_STREAM_MAX_LOG_BYTES) {
        count = EL_STREAM_MAX_LOG_BYTES;
        while (count > 0 && ((uint8_t)text[count] & 0xC0) == 0x80) { /* inside a UTF-8 character */
            count--;
        }
    }
    if (!el_packet_fits(&stream->writer, count) && stream->state == EL_STREAM_RUNNING) {
        el_stream_flush(stream);
    }
    if (stream->state == EL_STREAM_GONE) {
        return EL_STREAM_LINK_GONE;
    }
    if (!el_packet_fits(&stream->writer, count)) {
        return 0;
    }
    send_log(stream, text, count);
    return el_stream_push(stream) ? (int32_t)count : EL_STREAM_LINK_GONE;
}
