/* The link's rate: what the host asks for, the change when the last bit of the answer is out, and the way back.
 *
 * Both ends have to come back to the first rate by themselves, since at different rates neither hears the other: a device
 * that hears nothing at a new rate for a second, or in the state WAITING for three. While a change is under way nothing is
 * sent, and no frame begins. */
#include "stream/parts.h"

enum {
    NEAR_ENOUGH = 40
}; /* of the rate asked for, 1 / 40: a UART reads the last of 10 bits within half a bit of its place */

bool el_stream_has_rates(const el_stream *stream)
{
    const el_port *port = stream->config.port;
    return port->find_baud != NULL && port->set_baud != NULL && !stream->config.one_way;
}

void el_stream_take_rate(el_stream *stream, uint32_t rate)
{
    const el_port *port = stream->config.port;
    uint32_t found = 0;

    el_stream_wait_for_start(stream);
    if (el_stream_has_rates(stream) && rate >= 1 && rate <= stream->config.max_baud) {
        found = port->find_baud(port->context, rate);
    }
    const uint32_t off = found > rate ? found - rate : rate - found;
    stream->rate.next = found != 0 && off <= rate / NEAR_ENOUGH ? rate : stream->rate.now;
    stream->rate.answer_due = true;
}

/* Nothing is heard of a rate's proof before the next packet, so the time counts from here. */
static void changed(el_stream *stream)
{
    const bool back = stream->rate.next == stream->config.baud;
    stream->rate.now = stream->rate.next;
    stream->rate.changing = false;
    stream->rate.proven = back;
    stream->heard_us = el_stream_now_us(stream);
    stream->hello_us = stream->heard_us;
    stream->hello_due = stream->hello_due || back;
}

void el_stream_poll_rate(el_stream *stream)
{
    const el_port *port = stream->config.port;
    el_stream_rate *rate = &stream->rate;

    if (!rate->changing && rate->now != stream->config.baud && stream->state == EL_STREAM_WAITING &&
        el_stream_now_us(stream) - stream->heard_us >=
            (rate->proven ? (uint32_t)EL_STREAM_SILENCE_US : (uint32_t)EL_STREAM_PATIENCE_US)) {
        rate->next = stream->config.baud;
        rate->answer_due = false;
        rate->changing = true;
    }
    if (rate->changing && el_stream_push(stream) && el_stream_unsent(stream) == 0 &&
        port->set_baud(port->context, rate->next)) {
        changed(stream);
    }
}
