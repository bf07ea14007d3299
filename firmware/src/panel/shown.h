/* What a display shows, as one hash per segment of each line: enough to tell what need not be sent again, in a sixteenth
 * of the framebuffer that it stands for.
 *
 * Each step of a hash is a bijection of the word that it takes, so a change of one or two pixels that share a word is seen
 * always. Any other change is missed with a probability of 2^-32. At worst, when all 2,400 segments of 320x240 pixels
 * change in all of 60 frames a second, that is one segment in 8 hours; it is right again when it changes next, or when
 * its driver refreshes it. */
#ifndef EL_PANEL_SHOWN_H
#define EL_PANEL_SHOWN_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Pixels. The last segment of a line may be shorter. */
enum { EL_SHOWN_SEGMENT = 32 };

#define EL_SHOWN_SEGMENTS(width) (((width) + EL_SHOWN_SEGMENT - 1U) / EL_SHOWN_SEGMENT)

/* Of the hashes of a picture. */
#define EL_SHOWN_BYTES(width, height) (4U * EL_SHOWN_SEGMENTS(width) * (height))

/* A part of a band: columns [left, right) of lines [top, bottom), counted from the band's first. */
typedef struct el_shown_part {
    uint16_t left, right;
    uint16_t top, bottom;
} el_shown_part;

static inline bool el_shown_is_empty(const el_shown_part *part)
{
    return part->top == part->bottom;
}

/* Makes `hashes`, which are those of the band's lines, the hashes of `pixels`. Returns the smallest part that has all
 * segments whose hash was another; an empty one where there is none. 1 <= width, lines. */
el_shown_part el_shown_update(uint32_t *hashes, const uint16_t *pixels, unsigned width, unsigned lines);

/* Extends `part` so that it has all of lines [top, bottom), top < bottom, of a band that is `width` pixels wide. */
void el_shown_add_lines(el_shown_part *part, unsigned width, unsigned top, unsigned bottom);

/* Moves a part's lines together, so that they follow each other without the pixels between them: at the place of its first
 * pixel in the band, which is returned. What was beside them is lost. */
uint16_t *el_shown_pack(uint16_t *pixels, unsigned width, const el_shown_part *part);

#ifdef __cplusplus
}
#endif

#endif
