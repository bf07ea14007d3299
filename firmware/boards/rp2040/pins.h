/* Where things are on the Pico's header; WIRING.md has the same as a table and a picture. */
#ifndef EL_BOARDS_RP2040_PINS_H
#define EL_BOARDS_RP2040_PINS_H

enum {
    EL_PIN_UART_TX = 0,
    EL_PIN_UART_RX = 1,
    EL_PIN_CS = 17,
    EL_PIN_SCK = 18,
    EL_PIN_TX = 19,
    EL_PIN_DC = 20,
    EL_PIN_RESET = 21,
    EL_PIN_BACKLIGHT = 22
};

#endif
