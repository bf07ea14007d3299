/* Frames into the stream: an el_sink that sends the lines that the host does not have.
 *
 * begin decides whether the frame is sent at all (a host with credits, and its turn when START named a frame rate).
 * rows computes each line's CRC-32; a line goes out when it is due (after START or KEY, or its turn to be refreshed) or
 * when its CRC is not that of the line sent last. Lines that follow each other share a BAND packet up to its largest
 * size. The band is free again when rows returns: its pixels go straight to the wire or, in codec 2, into the packet that
 * is being built, which may go on with the next band. end sends
 * FRAME_END with the digest and the counters and waits until the link has it all.
 *
 * A frame that is not sent costs a comparison per band. A frame whose size is not that of the stream is never sent; a
 * LOG packet says so. */
#ifndef EL_STREAM_SINK_H
#define EL_STREAM_SINK_H

#include "base/sink.h"
#include "stream/session.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The sink of `stream`, which must outlive it. One renderer per stream. */
el_sink el_stream_sink(el_stream *stream);

#ifdef __cplusplus
}
#endif

#endif
