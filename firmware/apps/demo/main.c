/* The demo on a board: all scenes on its panel and, at the same time, on its stream; the host chooses among them.
 *
 * The display never depends on the host: a frame goes to both, and the stream gives up on a host that does not listen. */
#include "board.h"
#include "cortex_m/fault.h"
#include "demo/demo_panel.h"
#include "edgeline.h"
#include "player.h"
#include "stream/sink.h"

const char el_firmware_name[] = "edgeline-demo 0.1.0";

static uint8_t memory[EL_DEMO_MEMORY_BYTES]; /* the stream's, then the renderer's */

/* There is nobody to tell about an error in what was decided when the program was built. The watchdog or a debugger
 * finds the program here. */
static void must(bool good)
{
    while (!good) {
    }
}

static const el_board *board;

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
    must(el_demo_panel_start(board->bus, &panel) == EL_OK);

    static el_player player;
    player.scene = el_scene_find(EL_DEMO_SCENE);

    static el_stream stream;
    const size_t stream_bytes = EL_STREAM_MEMORY_BYTES(panel.width, panel.height);
    must(el_stream_init(&stream, &(el_stream_config){.port = &link,
                                                     .width = panel.width,
                                                     .height = panel.height,
                                                     .target = board->name,
                                                     .firmware = el_firmware_name,
                                                     .boot_id = board->boot_id,
                                                     .max_baud = board->max_baud,
                                                     .input = el_player_input,
                                                     .input_context = &player,
                                                     .memory = memory,
                                                     .memory_bytes = stream_bytes}) == 0);
    (void)el_stream_poll(&stream); /* HELLO */
    (void)el_stream_log(&stream, greeting, sizeof greeting - 1);
    const el_sink stream_sink = el_stream_sink(&stream);

    /* The panel comes last, because it may change the order of a band's bytes. */
    static el_renderer renderer;
    must(el_init(&renderer, &(el_config){.width = panel.width,
                                         .height = panel.height,
                                         .band_lines = EL_DEMO_BAND_LINES,
                                         .memory = memory + stream_bytes,
                                         .memory_bytes = sizeof memory - stream_bytes,
                                         .sinks = {&stream_sink, &panel.sink}}) == EL_OK);
    for (;;) {
        el_board_feed();
        must(el_player_play(&player, &renderer) == EL_OK);
    }
}
