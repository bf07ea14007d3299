/* Bytes in: the receiver, the reset line and the errors of the LCD model.
 *
 * The receiver knows commands by their table entries only (dcs_commands.c): how many parameters they take, and whether
 * pixels follow. What they do is in dcs_execute.c. All sections are of the ILI9341 data sheet V1.11. */
#include "dcs_lcd.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "dcs_commands.h"
#include "dcs_state.h"

static const uint64_t RESET_PULSE_NS = 10000;  /* section 15.4, tRW */
static const uint64_t RESET_IGNORED_NS = 5000; /* section 15.4, note 2: shorter pulses are rejected */

const el_lcd_profile EL_LCD_ILI9341 = {
    .name = "ILI9341", .columns = 240, .rows = 320, .all_lines = 0x27, .mirrored = true, .bgr_filter = true};

el_lcd_profile el_lcd_dcs(uint16_t columns, uint16_t rows)
{
    return (el_lcd_profile){.name = "dcs", .columns = columns, .rows = rows, .mirrored = true, .bgr_filter = true};
}

void el_lcd_report(el_lcd *lcd, el_lcd_fault fault, const char *format, ...)
{
    lcd->faults[fault]++;
    if (lcd->errors++ >= EL_LCD_ERRORS_KEPT) {
        return;
    }
    el_lcd_error *error = &lcd->kept[lcd->errors - 1];
    error->fault = fault;
    error->byte = lcd->bytes;
    const int prefix =
        snprintf(error->text, sizeof error->text, "%s: byte %llu: ", lcd->profile.name, (unsigned long long)lcd->bytes);
    if (prefix < 0 || (size_t)prefix >= sizeof error->text) {
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(error->text + prefix, sizeof error->text - (size_t)prefix, format, arguments);
    va_end(arguments);
}

static void hardware_reset(el_lcd *lcd)
{
    el_lcd_default_registers(lcd);
    lcd->sleep_in.until_ns = 0; /* a sleep-out sequence under way has ended */
    lcd->command = NULL;
    lcd->excess_reported = false;
    lcd->parameter_count = 0;
    lcd->pixel_count = 0;
}

static void check_wait(el_lcd *lcd, const el_lcd_wait *wait, const el_dcs_command *command)
{
    if (lcd->now_ns < wait->until_ns) {
        el_lcd_report(lcd, EL_LCD_TOO_SOON, "%02Xh %s comes %llu us too soon after %s (section %s)", command->code,
                      command->name, (unsigned long long)((wait->until_ns - lcd->now_ns + 999) / 1000), wait->after,
                      command->section);
    }
}

void el_lcd_reset(el_lcd *lcd, int level)
{
    const bool low = level == 0;
    if (low == lcd->reset_low) {
        return;
    }
    lcd->reset_low = low;
    if (low) {
        lcd->reset_low_since_ns = lcd->now_ns;
        lcd->excess_reported = false;
        return;
    }
    const uint64_t pulse_ns = lcd->now_ns - lcd->reset_low_since_ns;
    if (pulse_ns < RESET_PULSE_NS) {
        el_lcd_report(lcd, EL_LCD_SHORT_RESET, "reset was low for %llu ns, it takes %llu (section 15.4)",
                      (unsigned long long)pulse_ns, (unsigned long long)RESET_PULSE_NS);
    }
    if (pulse_ns < RESET_IGNORED_NS) {
        return;
    }
    el_lcd_wait_after_reset(lcd, "reset");
    hardware_reset(lcd);
}

/* The receiver. */

static bool takes_pixels(const el_dcs_command *command)
{
    return command->code == EL_DCS_RAMWR || command->code == EL_DCS_RAMWRC;
}

static void close_command(el_lcd *lcd)
{
    const el_dcs_command *command = lcd->command;
    if (command != NULL && lcd->parameter_count < command->min_parameters) {
        el_lcd_report(lcd, EL_LCD_TOO_FEW, "%02Xh %s had %u parameters, it takes %u (section %s)", command->code,
                      command->name, lcd->parameter_count, command->min_parameters, command->section);
    }
    if (command != NULL && lcd->pixel_count != 0) {
        el_lcd_report(lcd, EL_LCD_HALF_PIXEL, "%02Xh %s ended after %u of the %u bytes of a pixel", command->code,
                      command->name, lcd->pixel_count, lcd->pixel_bytes);
    }
    lcd->parameter_count = 0;
    lcd->pixel_count = 0;
    lcd->excess_reported = false;
}

static void command_byte(el_lcd *lcd, uint8_t byte)
{
    close_command(lcd);
    lcd->command = el_dcs_find(byte);
    if (lcd->command == NULL) {
        el_lcd_report(lcd, EL_LCD_UNKNOWN, "command %02Xh is not known to this model", byte);
        lcd->excess_reported = true; /* its parameters belong to the same error */
        return;
    }
    check_wait(lcd, &lcd->any, lcd->command);
    if (byte == EL_DCS_SLPOUT) {
        check_wait(lcd, &lcd->sleep_out, lcd->command);
    }
    if (byte == EL_DCS_SLPIN || byte == EL_DCS_SWRESET) {
        check_wait(lcd, &lcd->sleep_in, lcd->command);
    }
    if (lcd->command->max_parameters == 0) {
        el_lcd_execute(lcd);
    }
}

static void data_byte(el_lcd *lcd, uint8_t byte)
{
    const el_dcs_command *command = lcd->command;
    if (command != NULL && takes_pixels(command)) {
        el_lcd_pixel_byte(lcd, byte);
    } else if (command != NULL && lcd->parameter_count < command->max_parameters) {
        lcd->parameters[lcd->parameter_count++] = byte;
        if (lcd->parameter_count == command->min_parameters) { /* what is optional changes nothing in this model */
            el_lcd_execute(lcd);
        }
    } else if (!lcd->excess_reported) {
        lcd->excess_reported = true;
        if (command == NULL) {
            el_lcd_report(lcd, EL_LCD_NO_COMMAND, "data %02Xh before any command", byte);
        } else {
            el_lcd_report(lcd, EL_LCD_TOO_MANY,
                          "data %02Xh after %02Xh %s, which takes %u; pixels need 2Ch RAMWR first (%s)", byte,
                          command->code, command->name, command->max_parameters, command->section);
        }
    }
}

void el_lcd_write(el_lcd *lcd, int dc, uint8_t byte)
{
    if (lcd->reset_low) {
        if (!lcd->excess_reported) {
            lcd->excess_reported = true;
            el_lcd_report(lcd, EL_LCD_IN_RESET, "%s %02Xh while the reset line is low", dc != 0 ? "data" : "command",
                          byte);
        }
    } else if (dc != 0) {
        data_byte(lcd, byte);
    } else {
        command_byte(lcd, byte);
    }
    lcd->bytes++;
}

void el_lcd_advance_ns(el_lcd *lcd, uint64_t ns)
{
    lcd->now_ns += ns;
}

void el_lcd_finish(el_lcd *lcd)
{
    close_command(lcd);
    lcd->command = NULL;
}

/* Life and questions. */

/* Section 8.2.22: "contents of memory is set randomly" at power-on. The same noise each time, so that a run repeats;
 * Marsaglia's xorshift32, "Xorshift RNGs", 2003. */
static void fill_with_noise(el_lcd *lcd)
{
    const size_t count = (size_t)lcd->profile.columns * lcd->profile.rows;
    uint32_t state = 0x9341;
    for (size_t i = 0; i < count; i++) {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        lcd->memory[i] = state >> 14;
    }
}

el_lcd *el_lcd_create(const el_lcd_profile *profile)
{
    if (profile->columns == 0 || profile->columns > EL_LCD_MAX_SIDE || profile->rows == 0 ||
        profile->rows > EL_LCD_MAX_SIDE) {
        return NULL;
    }
    el_lcd *lcd = calloc(1, sizeof *lcd);
    if (lcd == NULL) {
        return NULL;
    }
    lcd->profile = *profile;
    lcd->memory = malloc((size_t)profile->columns * profile->rows * sizeof *lcd->memory);
    if (lcd->memory == NULL) {
        free(lcd);
        return NULL;
    }
    fill_with_noise(lcd);
    hardware_reset(lcd);
    return lcd;
}

void el_lcd_destroy(el_lcd *lcd)
{
    if (lcd != NULL) {
        free(lcd->memory);
        free(lcd);
    }
}

uint32_t el_lcd_memory(const el_lcd *lcd, unsigned column, unsigned row)
{
    return lcd->memory[(size_t)row * lcd->profile.columns + column];
}

uint64_t el_lcd_pixels(const el_lcd *lcd)
{
    return lcd->pixels;
}

uint64_t el_lcd_fault_count(const el_lcd *lcd, el_lcd_fault fault)
{
    return lcd->faults[fault];
}

uint64_t el_lcd_error_count(const el_lcd *lcd)
{
    return lcd->errors;
}

const el_lcd_error *el_lcd_error_at(const el_lcd *lcd, size_t index)
{
    return index < EL_LCD_ERRORS_KEPT && index < lcd->errors ? &lcd->kept[index] : NULL;
}
