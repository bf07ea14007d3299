/* Whole files in, and files out that are complete or not there at all. */
#ifndef EL_SIM_FILES_H
#define EL_SIM_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Reads a file into memory that the caller frees; it is aligned for any type. NULL, after one line on stderr, when it
 * cannot be read. */
uint8_t *el_file_read(const char *path, size_t *size);

/* A file under way: written beside its place and moved there at the end, so that what stood there before is lost only
 * when the new one is complete. Ctrl-C and the like leave nothing of it. */
typedef struct el_output {
    FILE *stream;     /* NULL: not open */
    const char *path; /* the caller's */
    char *temporary;
} el_output;

/* False, after one line on stderr, when it cannot be written. A zeroed el_output is a closed one. */
bool el_output_open(el_output *output, const char *path);
/* Writes 16-bit values, little-endian whatever the host is. */
void el_output_pixels(el_output *output, const uint16_t *values, size_t count);
/* The CRC-32 of what that writes. */
uint32_t el_pixels_crc(const uint16_t *values, size_t count);
/* Moves the file to its place. False, after one line on stderr, when anything could not be written. */
bool el_output_commit(el_output *output);
/* Removes what was written. Does nothing to one that is not open. */
void el_output_discard(el_output *output);

#endif
