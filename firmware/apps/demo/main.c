/* The demo on a board: all scenes on its panel and, at the same time, on its stream; the host chooses among them.
 *
 * The display never depends on the host: a frame goes to both, and the stream gives up on a host that does not
 * listen. */
#include "board.h"
#include "demo/demo_panel.h"
#include "edgeline.h"
#include "player.h"
#include "report.h"
#include "stream/sink.h"

const char el_firmware_name[] = "edgeline-demo 0.1.0";

static uint8_t memory[EL_DEMO_MEMORY_BYTES]; /* the stream's, then the renderer's */

static const el_board *board;

/* For calls that fail only when the program was built wrongly, too little memory for the panel say. The host's log
 * names the call; the board starts anew a second later, again and again, so a host that comes late reads it, too. Not
 * inlined, so that the address that a fault report says a call came from lies in main. */
__attribute__((noinline)) static void must(int32_t status, const char *call)
{
    if (status != EL_OK) {
        board->bus->delay_ms(board->bus->context, 1000);
        el_report_failure(call, status);
    }
}

/* A frame over a slow link takes longer than the watchdog's patience. The stream gives up by itself when nothing moves
 * (EL_STREAM_PATIENCE_US), so here the watchdog may be fed. */
static void wait_for_link(void *context)
{
    el_board_feed();
    if (board->port->wait != NULL) {
        board->port->wait(context);
    }
}

int main(void)
{
    static const char greeting[] = "demo on panel " EL_DEMO_PANEL;
    board = el_board_start();
    el_port link = *board->port;
    link.wait = wait_for_link;
    el_demo_panel panel;
    must(el_demo_panel_start(board->bus, &panel), "el_demo_panel_start");

    static el_player player;
    player.scene = el_scene_find(EL_DEMO_SCENE);

    static el_stream stream;
    const size_t stream_bytes = EL_STREAM_MEMORY_BYTES(panel.width, panel.height) +
                                (EL_STREAM_WITH_SPLIT ? EL_STREAM_SEGMENT_MEMORY_BYTES(panel.width, panel.height) : 0);
    const el_stream_config stream_config = {.port = &link,
                                            .width = panel.width,
                                            .height = panel.height,
                                            .target = board->name,
                                            .firmware = el_firmware_name,
                                            .boot_id = board->boot_id,
                                            .baud = board->baud,
                                            .max_baud = board->max_baud,
                                            .input = el_player_input,
                                            .input_context = &player,
                                            .scenes = (uint8_t)el_scene_count(),
                                            .controls = EL_PLAYER_CONTROLS,
                                            .views = EL_PLAYER_VIEWS,
                                            .segments = EL_STREAM_WITH_SPLIT,
                                            .memory = memory,
                                            .memory_bytes = stream_bytes};
    must(el_stream_init(&stream, &stream_config), "el_stream_init");
    (void)el_stream_poll(&stream); /* HELLO */
    (void)el_stream_log(&stream, greeting, sizeof greeting - 1);
    const el_sink stream_sink = el_stream_sink(&stream);

    /* The panel comes last, because it may change the order of a band's bytes and pixels. */
    static el_renderer renderer;
    const el_config config = {.width = panel.width,
                              .height = panel.height,
                              .band_lines = EL_DEMO_BAND_LINES,
                              .reuse = EL_DEMO_SPARING ? EL_REUSES : 0,
                              .memory = memory + stream_bytes,
                              .memory_bytes = sizeof memory - stream_bytes,
                              .sinks = {&stream_sink, &panel.sink}};
    must(el_init(&renderer, &config), "el_init");
    for (;;) {
        el_board_feed();
        must(el_player_play(&player, &renderer), "el_player_play");
    }
}
