/* What all displays have in common: how the module is mounted, and the order of the bytes of its pixels.
 *
 * Rotation and mirroring are those of the module as the viewer sees it, so that one picture suits every way of mounting:
 * the drivers turn the picture by the order in which they walk through the controller's memory. */
#ifndef EL_PANEL_PANEL_H
#define EL_PANEL_PANEL_H

#include <stdbool.h>

#include "base/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the module is turned, as seen by the viewer. Its upper edge is the one away from the flat cable. */
typedef enum el_rotation {
    EL_ROTATION_0,   /* upright */
    EL_ROTATION_90,  /* upper edge on the left */
    EL_ROTATION_180, /* upside down */
    EL_ROTATION_270  /* upper edge on the right */
} el_rotation;

/* Of the two bytes of a pixel on the wire. */
typedef enum el_byte_order { EL_HIGH_BYTE_FIRST, EL_LOW_BYTE_FIRST } el_byte_order;

/* How the axes of the picture, x to the right and y down, lie on the glass: along its columns and rows as they are
 * upright, or (sideways) x along a column and y along a row; and whether they run against them. */
typedef struct el_orientation {
    bool sideways;
    bool x_reversed;
    bool y_reversed;
} el_orientation;

static inline el_orientation el_panel_orientation(el_rotation rotation, bool mirrored)
{
    el_orientation lie;
    lie.sideways = rotation == EL_ROTATION_90 || rotation == EL_ROTATION_270;
    lie.x_reversed = (rotation == EL_ROTATION_180 || rotation == EL_ROTATION_270) != mirrored;
    lie.y_reversed = rotation == EL_ROTATION_90 || rotation == EL_ROTATION_180;
    return lie;
}

static inline bool el_panel_has_rotation(el_rotation rotation)
{
    return (unsigned)rotation <= EL_ROTATION_270;
}

/* Resets the controller by its line: held for 1 ms, which is enough for each of them, then `wait_ms` of rest. */
static inline void el_panel_reset(const el_bus *bus, uint32_t wait_ms)
{
    bus->reset(bus->context, 0);
    bus->delay_ms(bus->context, 1);
    bus->reset(bus->context, 1);
    bus->delay_ms(bus->context, wait_ms);
}

/* Lets the bus go on while somebody waits for it. */
static inline void el_panel_wait(const el_bus *bus)
{
    if (bus->wait != NULL) {
        bus->wait(bus->context);
    }
}

#ifdef __cplusplus
}
#endif

#endif
