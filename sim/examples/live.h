/* An example that somebody watches: its frames go over a pseudo-terminal to `edgeline view`, as a board's would, and its
 * keys are typed where it was started. */
#ifndef EL_SIM_EXAMPLES_LIVE_H
#define EL_SIM_EXAMPLES_LIVE_H

#include <stdbool.h>

/* Prints the pseudo-terminal's path, and goes on for `frames`, or until it is stopped where that is 0; a frame is drawn
 * when the host is ready for it. What an example sends to the display's wire by itself is not seen. False after one line on
 * stderr. */
bool example_watch(long frames);

#endif
