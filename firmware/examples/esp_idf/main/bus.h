/* The wire to a display over ESP-IDF's SPI master: an el_bus. */
#ifndef BUS_H
#define BUS_H

#include "base/bus.h"

/* Starts SPI2 and the pins; once. `max_bytes` is the longest transfer, a band. What it returns stays. */
const el_bus *bus_start(size_t max_bytes);

#endif
