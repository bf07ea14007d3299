/* What the machine must be: checked first, so that a wrong one gets one clear line before all that follows from it. */
#ifndef EL_BASE_MACHINE_H
#define EL_BASE_MACHINE_H

#if __SIZEOF_INT__ < 4
#error "Edgeline needs a 32-bit int (Cortex-M, RISC-V, ESP32 ...); AVR boards (Uno, Nano, Mega) have 16 bits"
#endif

#endif
