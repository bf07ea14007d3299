/* Sequences of frames that a codec is measured on: what the project draws, in seven kinds from easy to hard.
 *
 * All are functions of the frame's number alone; the page's layout is seeded. */
#ifndef EL_BENCH_CODEC_SEQUENCES_H
#define EL_BENCH_CODEC_SEQUENCES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/sink.h"

enum { CODEC_WIDTH = 320, CODEC_HEIGHT = 240, CODEC_BAND_LINES = 8, CODEC_FRAMES = 48, CODEC_SEQUENCES = 7 };

const char *codec_sequence_name(size_t sequence);

/* Draws one frame, 0 .. CODEC_FRAMES-1, into the sink. False when the renderer refuses it. */
bool codec_sequence_play(size_t sequence, uint32_t frame, const el_sink *sink);

#endif
