/* An example on a board: its panel, its clock, and letters that a terminal sends over the serial line as keys. */
#include "board.h"
#include "demo/demo_panel.h"
#include "example.h"
#include "report.h"

const char el_firmware_name[] = EXAMPLE_NAME;

static const el_board *board;

/* As in the demo: the report names the call, the board starts anew. */
static void must(int32_t status, const char *call)
{
    if (status != EL_OK) {
        board->bus->delay_ms(board->bus->context, 1000);
        el_report_failure(call, status);
    }
}

static char last_key(const el_port *port)
{
    uint8_t key = 0;
    while (port->read(port->context, &key, 1) > 0) {
    }
    return (char)(key & 0x7FU);
}

int main(void)
{
    board = el_board_start();
    const el_port *const port = board->port;
    static el_demo_panel panel;
    must(el_demo_panel_start(board->bus, &panel), "el_demo_panel_start");
    const example_screen screen = {.sink = &panel.sink, .bus = board->bus};
    must(example_setup(&screen), "example_setup");

    example_input input = {0};
    uint32_t counted_us = port->micros(port->context);
    for (;;) {
        el_board_feed();
        input.key = last_key(port);
        must(example_frame(&input), "example_frame");
        const uint32_t ms = (port->micros(port->context) - counted_us) / 1000U;
        counted_us += ms * 1000U;
        input.ms += ms;
    }
}
