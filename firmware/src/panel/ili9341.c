#include "panel/ili9341.h"

#include <stddef.h>

/* Commands: data sheet V1.11, section 8.2 (level 1) and 8.3 (level 2). */
enum {
    CMD_SLEEP_OUT = 0x11,        /* 8.2.12 */
    CMD_INVERSION_OFF = 0x20,    /* 8.2.15 */
    CMD_INVERSION_ON = 0x21,     /* 8.2.16 */
    CMD_DISPLAY_ON = 0x29,       /* 8.2.19 */
    CMD_COLUMN_ADDRESS = 0x2A,   /* 8.2.20 */
    CMD_PAGE_ADDRESS = 0x2B,     /* 8.2.21 */
    CMD_MEMORY_WRITE = 0x2C,     /* 8.2.22 */
    CMD_MEMORY_ACCESS = 0x36,    /* 8.2.29 */
    CMD_PIXEL_FORMAT = 0x3A,     /* 8.2.33 */
    CMD_FRAME_RATE = 0xB1,       /* 8.3.2 */
    CMD_DISPLAY_FUNCTION = 0xB6, /* 8.3.7 */
    CMD_POWER_1 = 0xC0,          /* 8.3.14 */
    CMD_POWER_2 = 0xC1,          /* 8.3.15 */
    CMD_VCOM_1 = 0xC5,           /* 8.3.16 */
    CMD_VCOM_2 = 0xC7            /* 8.3.17 */
};

enum {
    ACCESS_MY = 0x80,
    ACCESS_MX = 0x40,
    ACCESS_MV = 0x20,
    ACCESS_BGR = 0x08,
    FORMAT_16_BIT = 0x55, /* both interfaces, 8.2.33 */

    RESET_LOW_MS = 1,    /* 10 us at least, section 15.4 */
    RESET_WAIT_MS = 120, /* 5 ms; 120 ms before SLEEP OUT if the panel was awake, section 15.4 */
    SLEEP_OUT_MS = 120   /* 5 ms before the next command, 120 ms before another change of sleep, 8.2.12 */
};

typedef struct command {
    uint8_t code;
    uint8_t count;
    uint8_t parameters[4];
} command;

/* What differs from the reset values, voltages as in ILI Technology's application note. */
static const command start_up[] = {
    {CMD_POWER_1, 1, {0x23}},                      /* GVDD 4.60 V */
    {CMD_POWER_2, 1, {0x10}},                      /* booster steps: AVDD 2 VCI, VGH 7 VCI, VGL -4 VCI */
    {CMD_VCOM_1, 2, {0x3E, 0x28}},                 /* VCOMH 4.250 V, VCOML -1.500 V */
    {CMD_VCOM_2, 1, {0x86}},                       /* VCOM offset -58 steps */
    {CMD_FRAME_RATE, 2, {0x00, 0x18}},             /* 79 Hz: no division, 24 clocks per line */
    {CMD_DISPLAY_FUNCTION, 3, {0x08, 0x82, 0x27}}, /* normally white, scan and shift as reset has them, 320 lines */
    {CMD_PIXEL_FORMAT, 1, {FORMAT_16_BIT}},
};

/* Upright, column 0 of the controller's memory is on the viewer's right: MX mirrors it. */
static const uint8_t access_of_rotation[] = {
    [EL_ROTATION_0] = ACCESS_MX,
    [EL_ROTATION_90] = ACCESS_MV,
    [EL_ROTATION_180] = ACCESS_MY,
    [EL_ROTATION_270] = ACCESS_MX | ACCESS_MY | ACCESS_MV,
};

static void send(const el_bus *bus, uint8_t code, const uint8_t *parameters, size_t count)
{
    bus->command(bus->context, code, parameters, count);
}

void el_ili9341_init(el_ili9341 *panel, const el_ili9341_config *config)
{
    const el_bus *const bus = config->bus;
    *panel = (el_ili9341){.config = *config};

    bus->reset(bus->context, 0);
    bus->delay_ms(bus->context, RESET_LOW_MS);
    bus->reset(bus->context, 1);
    bus->delay_ms(bus->context, RESET_WAIT_MS);
    for (size_t i = 0; i < sizeof start_up / sizeof start_up[0]; i++) {
        send(bus, start_up[i].code, start_up[i].parameters, start_up[i].count);
    }
    const uint8_t access = (uint8_t)(access_of_rotation[config->rotation] | (config->rgb_order ? 0 : ACCESS_BGR));
    send(bus, CMD_MEMORY_ACCESS, &access, 1);
    send(bus, config->inverted ? CMD_INVERSION_ON : CMD_INVERSION_OFF, NULL, 0);
    send(bus, CMD_SLEEP_OUT, NULL, 0);
    bus->delay_ms(bus->context, SLEEP_OUT_MS);
    send(bus, CMD_DISPLAY_ON, NULL, 0);
}

static void set_range(const el_bus *bus, uint8_t code, uint16_t begin, uint16_t end)
{
    /* The controller's ranges include their last element. */
    const uint16_t last = (uint16_t)(end - 1U);
    const uint8_t range[4] = {(uint8_t)(begin >> 8), (uint8_t)begin, (uint8_t)(last >> 8), (uint8_t)last};
    send(bus, code, range, sizeof range);
}

static void begin(void *context, uint16_t width, uint16_t height)
{
    el_ili9341 *const panel = context;
    panel->width = width;
    panel->height = height;
    panel->next_line = height;
}

static void first_sent(void *context)
{
    const el_ili9341 *const panel = context;
    el_band_release(panel->loans[0].band, panel->loans[0].slot);
}

static void second_sent(void *context)
{
    const el_ili9341 *const panel = context;
    el_band_release(panel->loans[1].band, panel->loans[1].slot);
}

static void rows(void *context, el_band *band, unsigned slot)
{
    el_ili9341 *const panel = context;
    const el_bus *const bus = panel->config.bus;
    if (band->y != panel->next_line) {
        set_range(bus, CMD_COLUMN_ADDRESS, 0, panel->width);
        set_range(bus, CMD_PAGE_ADDRESS, band->y, panel->height);
        send(bus, CMD_MEMORY_WRITE, NULL, 0);
    }
    panel->next_line = (uint16_t)(band->y + band->lines);
    /* The bus may still be sending the other band, so each has its own entry and its own end. */
    const uint8_t loan = panel->next_loan;
    panel->next_loan ^= 1U;
    panel->loans[loan].band = band;
    panel->loans[loan].slot = slot;
    bus->pixels(bus->context, band->pixels, (size_t)band->lines * band->width, loan == 0 ? first_sent : second_sent,
                panel);
}

static void end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static void wait(void *context)
{
    const el_bus *const bus = ((el_ili9341 *)context)->config.bus;
    if (bus->wait != NULL) {
        bus->wait(bus->context);
    }
}

el_sink el_ili9341_sink(el_ili9341 *panel)
{
    return (el_sink){.context = panel, .begin = begin, .rows = rows, .end = end, .wait = wait};
}
