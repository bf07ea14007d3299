/* A device in lock-step with its tester: the real session, encoder, renderer and scenes on a clock that only the tester
 * moves. It reads requests from its standard input and answers on its standard output; the same requests have the same
 * answers, to the byte, on every machine.
 *
 *     request  = kind u8, size u32, `size` bytes          all numbers little-endian
 *     answer   = *( record ) DONE                         record = kind u8, size u32, `size` bytes
 *
 *     BOOT 'B'      width u16, height u16, band lines u16, ring u16 (bytes that the port takes ahead of the wire, 0: 1024),
 *                   rate u32 (at the start; 0: a link without rates that takes everything at once), highest rate u32,
 *                   render time u32 (us per frame), clock u32 (us, now), boot id u32, frame u16, seq u8 (the numbers of the
 *                   first frame and packet), flags u8 (1: skip by segments, 2: pictures in TRUTH, 4: one way),
 *                   the scene's name. A start of the device, in the middle of a frame too: what the port held is lost.
 *     ADVANCE 'A'   us u32, then bytes that arrive now. The device runs for that time.
 *
 *     WIRE 'W'      rate u32, bytes that left the device at that rate
 *     TRUTH 'T'     frame u16, digest u32 (as FRAME_END has it where no line is left out), frames sent before it since the
 *                   start u32, and the picture as u16 pixels if it was asked for; comes before the frame's FRAME_END, for frames that are not sent too
 *     INPUT 'I'     control u8, value i32, as the program got it
 *     DONE 'D'      clock u32, rate u32, frames drawn u32, stalls u32, damaged u32, missed u32, state u8, credits u8
 *
 * The exchange takes place inside the port's `wait` and in the time that rendering takes, wherever the device is by then:
 * a request is answered in the middle of a frame as at any other moment. So BOOT has to leave any depth of calls, which is
 * what longjmp does, and a reset. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/crc32.h"
#include "edgeline.h"
#include "player.h"
#include "stream/changes.h"
#include "stream/sink.h"

enum {
    MAX_SIDE = 320,
    MAX_PAYLOAD = 65536, /* of a request */
    MAX_RING = 65535,
    USUAL_RING = 1024,
    RX_BYTES = 4096,
    WAIT_US = 500, /* `wait` returns after that time at the latest; a board's tick is 1 ms */
    VERTICES = 2000,
    TRIANGLES = 3000,
    DRAWS = 16,
    BOOT_BYTES = 32,
    SEGMENTS = 1, /* flags */
    PICTURES = 2,
    ONE_WAY = 4
};

typedef struct boot_request {
    uint16_t width, height, band_lines, ring;
    uint32_t rate, max_rate, render_us, clock_us, boot_id;
    uint16_t frame;
    uint8_t seq;
    uint8_t flags;
    const el_scene *scene;
} boot_request;

static struct {
    boot_request boot;
    uint32_t clock_us;
    uint32_t until_us; /* when the request under way is answered */
    uint32_t rate;
    uint8_t ring[MAX_RING]; /* bytes that are on their way to the wire, the first one next */
    size_t ring_used;
    uint64_t ring_due; /* byte-microseconds that the wire has had and not used */
    uint8_t rx[RX_BYTES];
    size_t rx_used;
    uint16_t picture[MAX_SIDE * MAX_SIDE];
    uint32_t frames;
    uint32_t sent; /* of them, with their FRAME_END */
    el_player player;
    el_stream stream;
    bool running;
} device;

static jmp_buf start;

/* --- The tester --------------------------------------------------------------------------------------------------- */

static _Noreturn void fail(const char *why)
{
    (void)fprintf(stderr, "device: %s\n", why);
    exit(2);
}

static void put_u16(uint8_t *to, uint32_t value)
{
    to[0] = (uint8_t)value;
    to[1] = (uint8_t)(value >> 8);
}

static void put_u32(uint8_t *to, uint32_t value)
{
    put_u16(to, value);
    put_u16(to + 2, value >> 16);
}

static uint16_t get_u16(const uint8_t *from)
{
    return (uint16_t)(from[0] | from[1] << 8);
}

static uint32_t get_u32(const uint8_t *from)
{
    return get_u16(from) | (uint32_t)get_u16(from + 2) << 16;
}

/* A record of two pieces, one of which may be empty. */
static void tell(char kind, const uint8_t *head, size_t head_bytes, const void *rest, size_t rest_bytes)
{
    uint8_t frame[5] = {(uint8_t)kind};
    put_u32(frame + 1, (uint32_t)(head_bytes + rest_bytes));
    if (fwrite(frame, 1, sizeof frame, stdout) != sizeof frame || fwrite(head, 1, head_bytes, stdout) != head_bytes ||
        fwrite(rest, 1, rest_bytes, stdout) != rest_bytes) {
        fail("nobody reads the answers");
    }
}

static void tell_done(void)
{
    const el_stream *stream = &device.stream;
    uint8_t body[26];
    put_u32(body, device.clock_us);
    put_u32(body + 4, device.rate);
    put_u32(body + 8, device.frames);
    put_u32(body + 12, stream->stalls);
    put_u32(body + 16, stream->damaged);
    put_u32(body + 20, stream->missed);
    body[24] = stream->state;
    body[25] = stream->credits;
    tell('D', body, sizeof body, NULL, 0);
    if (fflush(stdout) != 0) {
        fail("nobody reads the answers");
    }
}

static void read_exactly(uint8_t *bytes, size_t count)
{
    const size_t got = fread(bytes, 1, count, stdin);
    if (got != count) {
        exit(ferror(stdin) ? 2 : 0); /* the tester is done */
    }
}

static void take_boot(const uint8_t *body, size_t count)
{
    static char name[64];
    if (count <= BOOT_BYTES || count - BOOT_BYTES >= sizeof name) {
        fail("BOOT has 32 bytes and the name of a scene");
    }
    memcpy(name, body + BOOT_BYTES, count - BOOT_BYTES);
    name[count - BOOT_BYTES] = '\0';
    device.boot = (boot_request){.width = get_u16(body),
                                 .height = get_u16(body + 2),
                                 .band_lines = get_u16(body + 4),
                                 .ring = get_u16(body + 6),
                                 .rate = get_u32(body + 8),
                                 .max_rate = get_u32(body + 12),
                                 .render_us = get_u32(body + 16),
                                 .clock_us = get_u32(body + 20),
                                 .boot_id = get_u32(body + 24),
                                 .frame = get_u16(body + 28),
                                 .seq = body[30],
                                 .flags = body[31],
                                 .scene = el_scene_find(name)};
    if (device.boot.scene == NULL) {
        fail("no such scene; `edgeline-sim list` names them");
    }
    if (device.boot.width > MAX_SIDE || device.boot.height > MAX_SIDE) {
        fail("pictures have at most 320 x 320 pixels");
    }
    if (device.boot.render_us == 0) {
        fail("a frame takes 1 us at least");
    }
    device.boot.ring = device.boot.ring != 0 ? device.boot.ring : USUAL_RING;
}

/* Answers the request under way, if there is one, and takes the next. */
static void exchange(void)
{
    static uint8_t payload[MAX_PAYLOAD];
    uint8_t frame[5];

    if (device.running) {
        tell_done();
    }
    read_exactly(frame, sizeof frame);
    const size_t count = get_u32(frame + 1);
    if (count > sizeof payload) {
        fail("requests have at most 65,536 bytes");
    }
    read_exactly(payload, count);
    if (frame[0] == 'B') {
        take_boot(payload, count);
        longjmp(start, 1);
    }
    if (frame[0] != 'A' || count < 4 || !device.running) {
        fail("the first request is BOOT, all others are BOOT or ADVANCE");
    }
    device.until_us = device.clock_us + get_u32(payload);
    const size_t room = sizeof device.rx - device.rx_used;
    const size_t taken = count - 4 < room ? count - 4 : room; /* as a board's ring: the rest is lost */
    memcpy(device.rx + device.rx_used, payload + 4, taken);
    device.rx_used += taken;
}

/* --- Time and the wire -------------------------------------------------------------------------------------------- */

static void send_from_ring(size_t count)
{
    uint8_t head[4];
    put_u32(head, device.rate);
    if (count > 0) {
        tell('W', head, sizeof head, device.ring, count);
        device.ring_used -= count;
        memmove(device.ring, device.ring + count, device.ring_used);
    }
}

/* What has left after `us` more: 10 bits a byte. */
static void drain_ring(uint32_t us)
{
    if (device.rate == 0) {
        send_from_ring(device.ring_used);
        return;
    }
    const uint64_t byte = 10000000U;
    device.ring_due += (uint64_t)us * device.rate;
    const uint64_t due = device.ring_due / byte;
    const size_t leaving = due < device.ring_used ? (size_t)due : device.ring_used;
    device.ring_due = leaving < due ? 0 : device.ring_due - leaving * byte; /* an idle wire saves nothing up */
    send_from_ring(leaving);
}

static void pass(uint32_t us)
{
    while (us > 0 || device.clock_us == device.until_us) {
        const uint32_t left = device.until_us - device.clock_us;
        const uint32_t step = us < left ? us : left;
        device.clock_us += step;
        us -= step;
        drain_ring(step);
        if (device.clock_us == device.until_us) {
            exchange();
        }
    }
}

static int32_t port_write(void *context, const uint8_t *bytes, size_t count)
{
    (void)context;
    const size_t room = device.boot.ring - device.ring_used;
    const size_t taken = count < room ? count : room;
    memcpy(device.ring + device.ring_used, bytes, taken);
    device.ring_used += taken;
    if (device.rate == 0) {
        send_from_ring(device.ring_used);
    }
    return (int32_t)taken;
}

static int32_t port_read(void *context, uint8_t *bytes, size_t capacity)
{
    (void)context;
    const size_t taken = capacity < device.rx_used ? capacity : device.rx_used;
    memcpy(bytes, device.rx, taken);
    device.rx_used -= taken;
    memmove(device.rx, device.rx + taken, device.rx_used);
    return (int32_t)taken;
}

static uint32_t port_micros(void *context)
{
    (void)context;
    return device.clock_us;
}

static uint32_t port_cycles(void *context)
{
    return 100 * port_micros(context); /* a processor of 100 MHz */
}

static uint32_t port_find_baud(void *context, uint32_t rate)
{
    (void)context;
    return rate;
}

static bool port_set_baud(void *context, uint32_t rate)
{
    (void)context;
    const bool idle = device.ring_used == 0;
    device.rate = idle ? rate : device.rate;
    return idle;
}

static void port_wait(void *context)
{
    (void)context;
    const uint32_t left = device.until_us - device.clock_us;
    pass(left < WAIT_US ? left : WAIT_US);
}

/* --- The program -------------------------------------------------------------------------------------------------- */

static void take_input(void *context, uint8_t control, int32_t value)
{
    uint8_t body[5] = {control};
    put_u32(body + 1, (uint32_t)value);
    tell('I', body, sizeof body, NULL, 0);
    el_player_input(context, control, value);
}

/* The sink before the stream's: it keeps the picture, and takes the time that rendering has. */

static void truth_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void truth_rows(void *context, el_band *band, unsigned slot)
{
    (void)context;
    const size_t pixels = (size_t)band->lines * band->width;
    memcpy(device.picture + (size_t)band->y * band->width, band->pixels, 2 * pixels);
    el_band_release(band, slot);
    pass((uint32_t)((uint64_t)device.boot.render_us * band->lines / device.boot.height));
}

static void truth_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
    const size_t line_bytes = 2 * (size_t)device.boot.width;
    uint32_t digest = 0;
    for (size_t y = 0; y < device.boot.height; y++) {
        const uint32_t crc = el_crc32(0, device.picture + y * device.boot.width, line_bytes);
        digest = el_changes_digest(digest, crc);
    }
    uint8_t head[10];
    put_u16(head, device.stream.frame.number);
    put_u32(head + 2, digest);
    put_u32(head + 6, device.sent);
    const bool pictures = (device.boot.flags & PICTURES) != 0;
    tell('T', head, sizeof head, device.picture, pictures ? line_bytes * device.boot.height : 0);
    device.frames++;
}

static void start_stream(const el_port *port)
{
    static uint8_t
        memory[EL_STREAM_MEMORY_BYTES(MAX_SIDE, MAX_SIDE) + EL_STREAM_SEGMENT_MEMORY_BYTES(MAX_SIDE, MAX_SIDE)];
    const boot_request *boot = &device.boot;
    const el_stream_config config = {.port = port,
                                     .width = boot->width,
                                     .height = boot->height,
                                     .target = "lock-step",
                                     .firmware = "edgeline-link-device",
                                     .boot_id = boot->boot_id,
                                     .baud = boot->rate,
                                     .max_baud = boot->max_rate,
                                     .one_way = (boot->flags & ONE_WAY) != 0,
                                     .input = take_input,
                                     .input_context = &device.player,
                                     .scenes = (uint8_t)el_scene_count(),
                                     .controls =
                                         1U << EL_CONTROL_SCENE | 1U << EL_CONTROL_FRAME | 1U << EL_CONTROL_PAUSE,
                                     .segments = (boot->flags & SEGMENTS) != 0,
                                     .memory = memory,
                                     .memory_bytes = sizeof memory};
    if (el_stream_init(&device.stream, &config) != 0) {
        fail("the stream refuses its configuration");
    }
    device.stream.frame.number = boot->frame;
    device.stream.writer.seq = boot->seq;
}

static void run(void)
{
    static uint8_t arena[EL_MEMORY_BYTES(MAX_SIDE, MAX_SIDE, MAX_SIDE, VERTICES, TRIANGLES, DRAWS)];
    static el_port port = {
        .write = port_write, .read = port_read, .micros = port_micros, .wait = port_wait, .cycles = port_cycles};
    port.find_baud = device.boot.rate != 0 ? port_find_baud : NULL;
    port.set_baud = device.boot.rate != 0 ? port_set_baud : NULL;
    static el_renderer renderer;

    device.clock_us = device.boot.clock_us;
    device.until_us = device.clock_us;
    device.rate = device.boot.rate;
    device.ring_used = 0;
    device.ring_due = 0;
    device.rx_used = 0;
    device.frames = 0;
    device.sent = 0;
    device.player = (el_player){.scene = device.boot.scene};
    start_stream(&port);
    device.running = true;

    const el_sink truth = {.begin = truth_begin, .rows = truth_rows, .end = truth_end};
    const el_sink stream_sink = el_stream_sink(&device.stream);
    const el_config config = {.width = device.boot.width,
                              .height = device.boot.height,
                              .band_lines = device.boot.band_lines,
                              .memory = arena,
                              .memory_bytes = sizeof arena,
                              .sinks = {&truth, &stream_sink}};
    if (el_init(&renderer, &config) != EL_OK) {
        fail("the renderer refuses its configuration: sizes are 1 to 320, a band has 1 to `height` lines");
    }
    for (;;) {
        (void)el_stream_poll(&device.stream);
        if (!el_stream_ready(&device.stream)) {
            port_wait(NULL);
        } else if (el_player_play(&device.player, &renderer) != EL_OK) {
            fail("the renderer does not draw the scene");
        } else {
            device.sent += device.stream.dropped == 0; /* the frame that has just ended */
        }
    }
}

int main(void)
{
    if (setjmp(start) == 0) {
        exchange();
    }
    run();
}
