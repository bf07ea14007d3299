/* The panel that the demo shows its pictures on. Which one it is the build says (EDGELINE_PANEL, boards.cmake): one of
 * the files panel_*.c beside this one is compiled. */
#ifndef EL_APPS_DEMO_PANEL_H
#define EL_APPS_DEMO_PANEL_H

#include "edgeline.h"

typedef struct el_demo_panel {
    el_sink sink;
    uint16_t width; /* of the glass as the viewer sees it, pixels */
    uint16_t height;
} el_demo_panel;

/* Resets and initialises the panel. EL_OK or the driver's error; what it gives stays. */
el_status el_demo_panel_start(const el_bus *bus, el_demo_panel *panel);

#endif
