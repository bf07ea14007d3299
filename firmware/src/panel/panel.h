/* What all displays have in common: how the module is mounted, and the order of its colours and bytes. */
#ifndef EL_PANEL_PANEL_H
#define EL_PANEL_PANEL_H

/* How the module is turned, as seen by the viewer. Its upper edge is the one away from the flat cable. */
typedef enum el_rotation {
    EL_ROTATION_0,   /* upright */
    EL_ROTATION_90,  /* upper edge on the left */
    EL_ROTATION_180, /* upside down */
    EL_ROTATION_270  /* upper edge on the right */
} el_rotation;

/* Of the two bytes of a pixel on the wire. */
typedef enum el_byte_order { EL_HIGH_BYTE_FIRST, EL_LOW_BYTE_FIRST } el_byte_order;

#endif
