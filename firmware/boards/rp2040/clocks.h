/* The RP2040's clocks. */
#ifndef EL_BOARDS_RP2040_CLOCKS_H
#define EL_BOARDS_RP2040_CLOCKS_H

#include <stdint.h>

enum { EL_PICO_CLOCK_HZ = 125000000, EL_PICO_CRYSTAL_HZ = 12000000, EL_PICO_RING_HZ = 6500000 };

/* Starts them, and the tick of timer and watchdog. Returns what clk_sys and clk_peri have come to: EL_PICO_CLOCK_HZ;
 * where the PLL does not lock, EL_PICO_CRYSTAL_HZ; where the crystal does not swing, about EL_PICO_RING_HZ, with which
 * the display works and the UART may not. Each wait has an end, so the program starts in any case. */
uint32_t el_pico_clocks_start(void);

/* Brings peripherals (EL_RESET_...) out of reset. */
void el_pico_release(uint32_t peripherals);

#endif
