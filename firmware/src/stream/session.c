/* The session: the host's packets change the state; what needs an answer is noted.
 *
 * Input may arrive in the middle of an outgoing packet, while that waits for room. Whatever needs an answer is therefore
 * sent by el_stream_poll, between two packets (output.c). */
#include "stream/session.h"

#include <string.h>

#include "stream/parts.h"

enum {
    MODE_BLOCK = 0,
    MODE_ROLL = 1,
    START_BYTES = 6,
    ACK_BYTES = 3,
    KEY_BYTES = 4,
    INPUT_BYTES = 5, /* and its number, from 1.2 on */
    SET_BAUD_BYTES = 4,
    MAX_CREDITS = 255,
    READ_BYTES = 32,
    READS_PER_POLL = 8 /* a host that floods the link does not stop the device */
};

_Static_assert(EL_STREAM_WIRE_BYTES >= (int)EL_COBS_ENCODER_MIN_BYTES, "the queue must hold an open block");
_Static_assert(EL_STREAM_WIRE_BYTES <= UINT16_MAX, "the queue counts in 16 bits");

void el_stream_wait_for_start(el_stream *stream)
{
    stream->frame.sending = false;
    stream->state = EL_STREAM_WAITING;
    stream->credits = 0;
    stream->hello_us = el_stream_now_us(stream);
}

bool el_stream_knows_roll(const el_stream *stream)
{
    return EL_STREAM_WIRE_BYTES >= EL_STREAM_ROLL_WIRE_BYTES(stream->config.width);
}

/* --- What the host says ------------------------------------------------------------------------------------------- */

void el_stream_make_due(el_stream *stream, uint32_t y0, uint32_t y1)
{
    for (uint32_t y = y0; y < y1; y++) {
        stream->lines_due[y / 8] = (uint8_t)(stream->lines_due[y / 8] | 1U << y % 8);
    }
}

static void take_start(el_stream *stream, const uint8_t *body)
{
    uint16_t frames_per_s = el_packet_get_u16(body + 2);
    uint16_t codecs = el_packet_get_u16(body + 4) & EL_STREAM_CODECS;

    if (body[0] > (el_stream_knows_roll(stream) ? MODE_ROLL : MODE_BLOCK)) {
        stream->notice = el_stream_knows_roll(stream)
                             ? "START refused: this device knows modes 0 (BLOCK) and 1 (ROLL) only"
                             : "START refused: this device knows mode 0 (BLOCK) only";
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
    stream->rolling = body[0] == MODE_ROLL;
    stream->cursor = 0;
    stream->asked = true;
    stream->dropped = 0;
    stream->period_us = frames_per_s == 0 ? 0 : 1000000U / frames_per_s;
    stream->frame_us = el_stream_now_us(stream) - stream->period_us; /* the first frame is due at once */
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

/* From 1.2 on an INPUT counts once, and in its turn: it has the number after that of the last one. */
static void take_input(el_stream *stream, const uint8_t *body, size_t count)
{
    const el_stream_config *config = &stream->config;
    const bool numbered = count > INPUT_BYTES;
    const uint8_t number = (uint8_t)(stream->input_number + 1);

    if (config->input == NULL || (numbered && body[INPUT_BYTES] != number)) {
        return;
    }
    stream->input_number = numbered ? number : stream->input_number;
    stream->input_came = true;
    config->input(config->input_context, body[0], (int32_t)el_packet_get_u32(body + 1));
}

/* A 1.0 or 1.1 host does not say its version. */
static void take_ping(el_stream *stream, const uint8_t *body, size_t count)
{
    const uint8_t major = count > 0 ? body[0] : EL_STREAM_PROTOCOL_MAJOR;

    stream->hello_due = true;
    stream->host_major = major;
    if (major != EL_STREAM_PROTOCOL_MAJOR) {
        stream->refusal_due = true;
        el_stream_wait_for_start(stream);
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
                    {EL_PACKET_INPUT, INPUT_BYTES},
                    {EL_PACKET_SET_BAUD, SET_BAUD_BYTES}};

    for (size_t i = 0; i < sizeof shortest / sizeof shortest[0]; i++) {
        if (packet->type == shortest[i].type && packet->body_bytes < shortest[i].body_bytes) {
            stream->damaged++;
            return;
        }
    }
    stream->heard_us = el_stream_now_us(stream);
    stream->rate.proven = true;
    if (packet->type == EL_PACKET_PING) {
        take_ping(stream, packet->body, packet->body_bytes);
    }
    if (stream->host_major != EL_STREAM_PROTOCOL_MAJOR) { /* who knows what its packets mean */
        return;
    }
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
        take_input(stream, packet->body, packet->body_bytes);
        break;
    case EL_PACKET_STOP:
        el_stream_wait_for_start(stream);
        break;
    case EL_PACKET_SET_BAUD:
        el_stream_take_rate(stream, el_packet_get_u32(packet->body));
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

void el_stream_receive(el_stream *stream)
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
        el_stream_lose_link(stream);
    }
}

/* --- The public door ---------------------------------------------------------------------------------------------- */

static bool is_name(const char *name)
{
    size_t count = 0;
    while (name != NULL && count <= EL_STREAM_MAX_NAME_BYTES && name[count] != '\0') {
        count++;
    }
    return name != NULL && count <= EL_STREAM_MAX_NAME_BYTES;
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
    el_packet_writer_init(&stream->writer, stream->wire, sizeof stream->wire, el_stream_drain, stream);
    stream->state = config->one_way ? EL_STREAM_RUNNING : EL_STREAM_WAITING;
    stream->codecs = EL_STREAM_OLD_CODECS; /* one-way; others say it in START */
    stream->hello_due = true;
    stream->hello_us = el_stream_now_us(stream);
    stream->rate.now = config->baud;
    stream->host_major = EL_STREAM_PROTOCOL_MAJOR;
    return 0;
}

int el_stream_poll(el_stream *stream)
{
    if (stream->state != EL_STREAM_GONE) {
        el_stream_receive(stream);
    }
    if (stream->state == EL_STREAM_RUNNING && !stream->config.one_way && stream->credits == 0 &&
        el_stream_now_us(stream) - stream->heard_us >= EL_STREAM_PATIENCE_US) {
        el_stream_wait_for_start(stream);
    }
    if (stream->state != EL_STREAM_GONE) {
        el_stream_poll_rate(stream);
        el_stream_send_pending(stream);
        el_stream_push(stream);
        stream->stalled = stream->stalled && (stream->hello_due || el_stream_unsent(stream) > 0);
    }
    return stream->state == EL_STREAM_GONE ? EL_STREAM_LINK_GONE : 0;
}

bool el_stream_ready(const el_stream *stream)
{
    return stream->state == EL_STREAM_RUNNING && !stream->rate.changing &&
           (stream->config.one_way ? !stream->stalled : stream->credits > 0) &&
           (stream->period_us == 0 || el_stream_now_us(stream) - stream->frame_us >= stream->period_us);
}
