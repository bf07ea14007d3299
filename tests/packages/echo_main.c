/* For port.c of PORTING.md: sends back what it gets, ECHO_BYTES of them, by the port alone; then, where the link takes
 * nothing, says how much it took and ends. */
#include <stdio.h>
#include <stdlib.h>

#include "base/port.h"
#include "chip.h"

enum { ECHO_BYTES = 5000, GIVE_UP_US = 1000000, LEAVE_US = 10000 };

int main(void)
{
    uint8_t bytes[64];
    size_t echoed = 0;
    size_t have = 0;
    size_t given = 0;

    chip_start();
    uint32_t moved_us = board_port.micros(NULL);
    while (echoed < ECHO_BYTES) {
        if (given == have) {
            have = (size_t)board_port.read(NULL, bytes, sizeof bytes);
            given = 0;
        }
        const size_t took = (size_t)board_port.write(NULL, bytes + given, have - given);
        given += took;
        echoed += took;
        if (took > 0) {
            moved_us = board_port.micros(NULL);
        } else if (board_port.micros(NULL) - moved_us >= GIVE_UP_US) {
            fprintf(stderr, "the link took %zu bytes\n", echoed);
            return 3;
        }
        board_port.wait(NULL);
    }
    const uint32_t echoed_us = board_port.micros(NULL);
    while (board_port.micros(NULL) - echoed_us < LEAVE_US) {
        board_port.wait(NULL);
    }
    chip_restart();
}
