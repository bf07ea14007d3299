/* SSD0323 (Solomon Systech): 128x64 OLED, 4 bits of grey per pixel, two pixels of a row in a byte.
 *
 * For the OSRAM Pictiva glass of the Stellaris evaluation boards (EK-LM3S6965). Sections are those of the data sheet of
 * its successor with the same command set, SSD1325 (Rev 2.3): the SSD0323's own could not be had. How the glass is
 * wired, and its voltages, are those of Luminary Micro's driver for the board (osram128x64x4.c, after OSRAM's
 * application note AN018). Only commands that QEMU's model of the board knows are sent. The driver is oled.h's. */
#ifndef EL_PANEL_SSD0323_H
#define EL_PANEL_SSD0323_H

#include "panel/oled.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef el_oled el_ssd0323;
typedef el_oled_config el_ssd0323_config;

/* Memory for bands of that height, 128 bytes per line. With less, but at least 128, `rows` waits for the wire more often,
 * and shows the same. */
#define EL_SSD0323_MEMORY_BYTES(band_lines) (2 * 64 * (band_lines))

/* Resets and initialises the controller. `config` is copied.
 * EL_ERROR_ARGUMENT: no memory, no bus or one that sends no bytes, or a rotation that does not exist. EL_ERROR_MEMORY:
 * less than 128 bytes. Then nothing was sent. */
el_status el_ssd0323_init(el_ssd0323 *panel, const el_ssd0323_config *config);

/* The sink, which refers to `panel`. A frame that is larger than the glass is not shown. */
el_sink el_ssd0323_sink(el_ssd0323 *panel);

#ifdef __cplusplus
}
#endif

#endif
