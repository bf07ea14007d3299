/* Names of files that come one per frame: "frame-%04d.png" stands for frame-0000.png, frame-0001.png, ... */
#ifndef EL_SIM_FRAME_NAME_H
#define EL_SIM_FRAME_NAME_H

#include <stdbool.h>
#include <stdint.h>

enum { EL_FRAME_NAME_MAX = 4096 }; /* bytes, the final zero too */

/* Whether there is a % in it. */
bool el_frame_name_is_pattern(const char *text);

/* Writes the name of `frame`, up to EL_FRAME_NAME_MAX bytes. False, after one line on stderr, when the pattern has
 * something else than one %d or %0Nd, N from 1 to 9, or is too long. */
bool el_frame_name(const char *pattern, uint32_t frame, char *name);

#endif
