/* What the tests of the LCD model share: sending commands, and pictures of letters.
 *
 * A letter is a pixel: its colour has the letter's code in the bits that survive every conversion of the model, so a
 * picture reads back as text. */
#ifndef EL_TEST_LCD_SEND_H
#define EL_TEST_LCD_SEND_H

#include <stddef.h>
#include <stdint.h>

#include "lcd/lcd.h"
#include "unity.h"

/* Seven bits: four in red, three in green's upper half; never white, never the grey of a copy-paste error. */
static inline uint16_t letter_colour(char letter)
{
    return (uint16_t)((letter >> 3 & 0xF) << 12 | (letter & 7) << 8);
}

static inline char colour_letter(uint16_t rgb565)
{
    const int code = rgb565 == 0xFFFF ? '.' : (rgb565 >> 12) << 3 | (rgb565 >> 8 & 7);
    return (char)code;
}

static inline void send_bytes(el_lcd *lcd, uint8_t command, const uint8_t *parameters, size_t count)
{
    el_lcd_write(lcd, 0, command);
    for (size_t i = 0; i < count; i++) {
        el_lcd_write(lcd, 1, parameters[i]);
    }
}

#define SEND(lcd, command, ...)                                                                                        \
    send_bytes(lcd, command, (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__}))

static inline void send_command(el_lcd *lcd, uint8_t command)
{
    send_bytes(lcd, command, NULL, 0);
}

/* Columns and pages, ends included. */
static inline void send_window(el_lcd *lcd, unsigned sc, unsigned ec, unsigned sp, unsigned ep)
{
    SEND(lcd, 0x2A, (uint8_t)(sc >> 8), (uint8_t)sc, (uint8_t)(ec >> 8), (uint8_t)ec);
    SEND(lcd, 0x2B, (uint8_t)(sp >> 8), (uint8_t)sp, (uint8_t)(ep >> 8), (uint8_t)ep);
}

/* The bytes of 16-bit pixels, without a command. */
static inline void send_letters(el_lcd *lcd, const char *letters)
{
    for (; *letters != 0; letters++) {
        el_lcd_write(lcd, 1, (uint8_t)(letter_colour(*letters) >> 8));
        el_lcd_write(lcd, 1, (uint8_t)letter_colour(*letters));
    }
}

/* Awake, on, 16 bits per pixel, all waiting times over. */
static inline void switch_on(el_lcd *lcd)
{
    send_command(lcd, 0x11);
    el_lcd_advance_ns(lcd, 120000000);
    send_command(lcd, 0x29);
    SEND(lcd, 0x3A, 0x55);
}

static inline void expect_no_errors(const el_lcd *lcd)
{
    if (el_lcd_error_count(lcd) != 0) {
        TEST_FAIL_MESSAGE(el_lcd_error_at(lcd, 0)->text);
    }
}

/* Expects these rows when the module is turned by `degrees`, up to 8 x 8. */
static inline void expect_look(const el_lcd *lcd, unsigned degrees, size_t rows, const char *const *picture)
{
    uint16_t pixels[64];
    char row[9] = {0};
    size_t next = 0;
    TEST_ASSERT_EQUAL_INT(0, el_lcd_look(lcd, degrees, pixels));
    for (size_t y = 0; y < rows; y++) {
        size_t width = 0;
        while (picture[y][width] != 0) {
            row[width++] = colour_letter(pixels[next++]);
        }
        row[width] = 0;
        TEST_ASSERT_EQUAL_STRING(picture[y], row);
    }
}

#define EXPECT_LOOK(lcd, degrees, ...)                                                                                 \
    expect_look(lcd, degrees, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *),                             \
                (const char *const[]){__VA_ARGS__})

#endif
