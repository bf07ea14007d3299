/* Bytes in: the receiver, the reset line, time and the errors of all models; and the glass from all sides.
 *
 * The receiver knows commands by their table entries only: how many parameters they take, and whether pixels follow.
 * What they do is their family's. */
#include "lcd.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "lcd_state.h"

static const el_lcd_family *family_of(const el_lcd *lcd)
{
    return lcd->profile.chip->family;
}

/* The command table. */

static const el_lcd_command *find_command(const el_lcd_chip *chip, uint8_t code)
{
    for (size_t i = 0; i < chip->command_count; i++) {
        if (code >= chip->commands[i].code && code <= chip->commands[i].last) {
            return &chip->commands[i];
        }
    }
    return NULL;
}

const char *el_lcd_section(const el_lcd *lcd, uint8_t code)
{
    return find_command(lcd->profile.chip, code)->section;
}

/* Errors. */

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

void el_lcd_report_command(el_lcd *lcd, el_lcd_fault fault, const char *what)
{
    el_lcd_report(lcd, fault, "%02Xh %s: %s (section %s)", lcd->code, lcd->command->name, what, lcd->command->section);
}

/* Time. */

el_lcd_wait el_lcd_wait_from_now(const el_lcd *lcd, uint64_t ns, const char *after)
{
    return (el_lcd_wait){lcd->now_ns + ns, after};
}

void el_lcd_check_wait(el_lcd *lcd, const el_lcd_wait *wait)
{
    if (lcd->now_ns < wait->until_ns) {
        el_lcd_report(lcd, EL_LCD_TOO_SOON, "%02Xh %s comes %llu us too soon after %s (section %s)", lcd->code,
                      lcd->command->name, (unsigned long long)((wait->until_ns - lcd->now_ns + 999) / 1000),
                      wait->after, lcd->command->section);
    }
}

void el_lcd_advance_ns(el_lcd *lcd, uint64_t ns)
{
    lcd->now_ns += ns;
}

/* The reset line. */

static void hardware_reset(el_lcd *lcd)
{
    family_of(lcd)->reset(lcd);
    lcd->sleep_in.until_ns = 0; /* a sleep-out sequence under way has ended */
    lcd->command = NULL;
    lcd->excess_reported = false;
    lcd->parameter_count = 0;
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
    const el_lcd_chip *chip = lcd->profile.chip;
    const uint64_t pulse_ns = lcd->now_ns - lcd->reset_low_since_ns;
    if (pulse_ns < chip->reset_pulse_ns) {
        el_lcd_report(lcd, EL_LCD_SHORT_RESET, "reset was low for %llu ns, it takes %llu (section %s)",
                      (unsigned long long)pulse_ns, (unsigned long long)chip->reset_pulse_ns, chip->reset_section);
    }
    if (pulse_ns >= chip->reset_ignored_ns) {
        hardware_reset(lcd);
    }
}

/* The receiver. */

static void close_command(el_lcd *lcd)
{
    const el_lcd_command *command = lcd->command;
    if (command != NULL && lcd->parameter_count < command->min_parameters) {
        el_lcd_report(lcd, EL_LCD_TOO_FEW, "%02Xh %s had %u parameters, it takes %u (section %s)", lcd->code,
                      command->name, lcd->parameter_count, command->min_parameters, command->section);
    }
    if (command != NULL && family_of(lcd)->close != NULL) {
        family_of(lcd)->close(lcd);
    }
    lcd->parameter_count = 0;
    lcd->excess_reported = false;
}

static void take_parameter(el_lcd *lcd, uint8_t byte)
{
    lcd->parameters[lcd->parameter_count++] = byte;
    if (lcd->parameter_count == lcd->command->min_parameters) { /* what is optional changes nothing in the models */
        family_of(lcd)->execute(lcd);
    }
}

static void command_byte(el_lcd *lcd, uint8_t byte)
{
    if (family_of(lcd)->parameters_are_commands && lcd->command != NULL &&
        lcd->parameter_count < lcd->command->min_parameters) {
        take_parameter(lcd, byte);
        return;
    }
    close_command(lcd);
    lcd->command = find_command(lcd->profile.chip, byte);
    lcd->code = byte;
    if (lcd->command == NULL) {
        el_lcd_report(lcd, EL_LCD_UNKNOWN, "command %02Xh is not known to this model", byte);
        lcd->excess_reported = true; /* its parameters belong to the same error */
        return;
    }
    el_lcd_check_wait(lcd, &lcd->any);
    if (family_of(lcd)->check != NULL) {
        family_of(lcd)->check(lcd);
    }
    if (lcd->command->max_parameters == 0) {
        family_of(lcd)->execute(lcd);
    }
}

/* Data of a chip whose parameters are data too. */
static void command_data(el_lcd *lcd, uint8_t byte)
{
    const el_lcd_command *command = lcd->command;
    if (command != NULL && family_of(lcd)->takes_pixels(command)) {
        family_of(lcd)->pixel_byte(lcd, byte);
    } else if (command != NULL && lcd->parameter_count < command->max_parameters) {
        take_parameter(lcd, byte);
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
    } else if (dc == 0) {
        command_byte(lcd, byte);
    } else if (family_of(lcd)->parameters_are_commands) {
        close_command(lcd);
        lcd->command = NULL;
        family_of(lcd)->pixel_byte(lcd, byte);
    } else {
        command_data(lcd, byte);
    }
    lcd->bytes++;
}

void el_lcd_finish(el_lcd *lcd)
{
    close_command(lcd);
    lcd->command = NULL;
}

/* Life. */

/* "Contents of memory is set randomly" at power-on (ILI9341, section 8.2.22). The same noise each time, so that a run
 * repeats; Marsaglia's xorshift32, "Xorshift RNGs", 2003. */
static void fill_with_noise(el_lcd *lcd)
{
    const size_t count = (size_t)lcd->profile.memory_columns * lcd->profile.memory_rows;
    const unsigned unused_bits = 32U - family_of(lcd)->memory_bits;
    uint32_t state = 0x9341;
    for (size_t i = 0; i < count; i++) {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        lcd->memory[i] = state >> unused_bits;
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
    lcd->memory = malloc((size_t)profile->memory_columns * profile->memory_rows * sizeof *lcd->memory);
    if (lcd->memory == NULL) {
        free(lcd);
        return NULL;
    }
    fill_with_noise(lcd);
    hardware_reset(lcd);
    lcd->any.until_ns = 0; /* power came long ago */
    return lcd;
}

void el_lcd_destroy(el_lcd *lcd)
{
    if (lcd != NULL) {
        free(lcd->memory);
        free(lcd);
    }
}

/* Questions. */

int el_lcd_look(const el_lcd *lcd, unsigned degrees, uint16_t *rgb565)
{
    if (degrees % 90 != 0 || degrees >= 360) {
        return -1;
    }
    const unsigned columns = lcd->profile.columns;
    const unsigned rows = lcd->profile.rows;
    const bool lies = degrees == 90 || degrees == 270;
    const unsigned width = lies ? rows : columns;
    const unsigned height = lies ? columns : rows;
    const bool lit = family_of(lcd)->is_lit(lcd);
    for (unsigned y = 0; y < height; y++) {
        for (unsigned x = 0; x < width; x++) {
            unsigned glass_x = lies ? y : x;
            unsigned glass_y = lies ? x : y;
            if (degrees == 180 || degrees == 270) {
                glass_x = columns - 1 - glass_x;
            }
            if (degrees == 90 || degrees == 180) {
                glass_y = rows - 1 - glass_y;
            }
            *rgb565++ = lit ? family_of(lcd)->glass_pixel(lcd, glass_x, glass_y) : lcd->profile.blank;
        }
    }
    return 0;
}

void el_lcd_glass(const el_lcd *lcd, uint16_t *rgb565)
{
    (void)el_lcd_look(lcd, 0, rgb565);
}

uint32_t *el_lcd_cell(el_lcd *lcd, unsigned column, unsigned row)
{
    return &lcd->memory[(size_t)row * lcd->profile.memory_columns + column];
}

uint32_t el_lcd_memory(const el_lcd *lcd, unsigned column, unsigned row)
{
    return lcd->memory[(size_t)row * lcd->profile.memory_columns + column];
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
