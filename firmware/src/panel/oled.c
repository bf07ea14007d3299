#include "panel/oled.h"

#include <string.h>

#include "base/dither.h"
#include "base/options.h"

/* Whether lines share bytes: the picture's y runs along the pixels of a byte. */
static bool lines_share(const el_oled *panel)
{
    return (panel->model->packs_columns != 0) != panel->lie.sideways;
}

uint16_t el_oled_width(const el_oled *panel)
{
    return panel->lie.sideways ? panel->model->rows : panel->model->columns;
}

uint16_t el_oled_height(const el_oled *panel)
{
    return panel->lie.sideways ? panel->model->columns : panel->model->rows;
}

/* --- Commands ----------------------------------------------------------------------------------------------------- */

static void send_byte(const el_oled *panel, uint8_t byte)
{
    const el_bus *const bus = panel->config.bus;
    bus->command(bus->context, byte, NULL, 0);
}

static void send(const el_oled *panel, const el_oled_command *command)
{
    send_byte(panel, command->code);
    for (size_t i = 0; i < command->count; i++) {
        send_byte(panel, command->parameters[i]);
    }
}

static void set_range(const el_oled *panel, bool columns, unsigned begin, unsigned end)
{
    send_byte(panel, columns ? panel->model->column_range : panel->model->row_range);
    send_byte(panel, (uint8_t)begin);
    send_byte(panel, (uint8_t)(end - 1U)); /* it includes its last element */
}

el_status el_oled_scroll(el_oled *panel, uint8_t by)
{
    const el_oled_model *const model = panel->model;
    if (model->start_line == 0) {
        return EL_ERROR_ARGUMENT;
    }
    if (by >= model->rows) {
        return EL_ERROR_SIZE;
    }
    const bool reversed = panel->lie.sideways ? panel->lie.x_reversed : panel->lie.y_reversed;
    send_byte(panel, (uint8_t)(model->start_line + (reversed && by > 0 ? model->rows - by : by)));
    return EL_OK;
}

/* The bytes along a unit are a range of columns, and units a range of rows; sideways it is the other way round. */
static void set_bytes(const el_oled *panel, unsigned begin, unsigned end)
{
    set_range(panel, !panel->lie.sideways, begin, end);
}

static void set_units(const el_oled *panel, unsigned begin, unsigned end)
{
    set_range(panel, panel->lie.sideways, begin, end);
}

/* --- Buffers ------------------------------------------------------------------------------------------------------ */

static uint8_t *buffer(const el_oled *panel, unsigned index)
{
    return panel->config.memory + index * (panel->config.memory_bytes / 2U);
}

static void first_sent(void *context)
{
    ((el_oled *)context)->sending[0] = false;
}

static void second_sent(void *context)
{
    ((el_oled *)context)->sending[1] = false;
}

static void await(const el_oled *panel, unsigned index)
{
    while (panel->sending[index]) {
        el_panel_wait(panel->config.bus);
    }
}

/* Sends `count` bytes of the buffer being filled and goes on with the other one, which is free: the bus ends one transfer
 * before it begins the next. */
static void send_buffer(el_oled *panel, const uint8_t *bytes, size_t count)
{
    const el_bus *const bus = panel->config.bus;
    const unsigned index = panel->filling;
    panel->sending[index] = true;
    bus->bytes(bus->context, bytes, count, index == 0 ? first_sent : second_sent, panel);
    panel->filling ^= 1U;
}

/* A buffer's units lie in the order of the controller's memory: backwards where y runs against it. */
static uint8_t *unit_at(const el_oled *panel, unsigned buffer_index, unsigned unit)
{
    const unsigned place = panel->lie.y_reversed ? panel->capacity - 1U - unit : unit;
    return buffer(panel, buffer_index) + (size_t)place * panel->unit_bytes;
}

static unsigned frame_units(const el_oled *panel)
{
    return ((panel->height - 1U) >> panel->lines_log2) + 1U;
}

/* Sends the finished units; the one that is begun moves to the other buffer. */
static void flush(el_oled *panel)
{
    const unsigned from = panel->filling;
    const unsigned end = (unsigned)panel->unit + panel->units;
    await(panel, from ^ 1U);
    if (panel->begun) {
        memcpy(unit_at(panel, from ^ 1U, 0), unit_at(panel, from, panel->units), panel->unit_bytes);
    }
    if (panel->lie.y_reversed) {
        /* Below what was sent before, so each run needs its window. */
        const unsigned glass_units = (unsigned)el_oled_height(panel) >> panel->lines_log2;
        set_units(panel, glass_units - end, glass_units - panel->unit);
    } else if (EL_WITH_REUSE && panel->moved) {
        set_units(panel, panel->unit, frame_units(panel));
    }
    panel->moved = false;
    send_buffer(panel, unit_at(panel, from, panel->lie.y_reversed ? panel->units - 1U : 0),
                (size_t)panel->units * panel->unit_bytes);
    panel->unit = (uint8_t)end;
    panel->units = 0;
}

/* The memory holds noise after power-on; what a smaller frame leaves free would show it for ever. */
static void blacken(el_oled *panel)
{
    const el_oled_model *const model = panel->model;
    const unsigned columns = model->columns >> (model->packs_columns != 0 ? 0 : model->packed_log2);
    const unsigned rows = model->rows >> (model->packs_columns != 0 ? model->packed_log2 : 0);
    const size_t half = panel->config.memory_bytes / 2U;
    set_range(panel, true, 0, columns);
    set_range(panel, false, 0, rows);
    for (size_t left = (size_t)columns * rows; left > 0;) {
        const size_t count = left < half ? left : half;
        memset(buffer(panel, panel->filling), 0, count);
        send_buffer(panel, buffer(panel, panel->filling), count);
        left -= count;
    }
}

/* --- Pixels ------------------------------------------------------------------------------------------------------- */

/* Where pixel `place` of the glass, counted along a byte's pixels, is in its byte. */
static unsigned shift_of(const el_oled_model *model, unsigned place)
{
    const unsigned last = (1U << model->packed_log2) - 1U;
    const unsigned slot = place & last;
    return (model->first_is_high != 0 ? last - slot : slot) << (3U - model->packed_log2);
}

/* Adds a line of the picture to a unit. The dither's pattern is the picture's, however it is turned. */
static void pack_line(const el_oled *panel, uint8_t *unit, const uint16_t *pixels, unsigned y)
{
    const el_oled_model *const model = panel->model;
    const unsigned levels = 0xFFU >> (8U - (8U >> model->packed_log2));
    const bool shared = lines_share(panel);
    const unsigned byte_log2 = shared ? 0 : model->packed_log2;
    const unsigned line_shift = shift_of(model, panel->lie.y_reversed ? el_oled_height(panel) - 1U - y : y);
    const unsigned first_byte = panel->first_byte;
    const unsigned width = panel->width;
    const bool reversed = panel->lie.x_reversed;
    unsigned place = reversed ? el_oled_width(panel) - 1U : 0;
    for (unsigned x = 0; x < width; x++) {
        const uint32_t level = el_dither(el_luma_q16(pixels[x]), levels, el_dither_threshold_q16(x, y));
        unit[(place >> byte_log2) - first_byte] |= (uint8_t)(level << (shared ? line_shift : shift_of(model, place)));
        place = reversed ? place - 1U : place + 1U;
    }
}

/* --- The sink ----------------------------------------------------------------------------------------------------- */

static void begin(void *context, uint16_t width, uint16_t height)
{
    el_oled *const panel = context;
    const uint16_t glass_width = el_oled_width(panel);
    const uint16_t glass_height = el_oled_height(panel);
    const bool changed = width != panel->width || height != panel->height;
    panel->fits = width <= glass_width && height <= glass_height && width > 0 && height > 0;
    panel->width = width;
    panel->height = height;
    if (!panel->fits) {
        return;
    }
    if (changed && (width < glass_width || height < glass_height)) {
        blacken(panel);
    }
    const unsigned byte_log2 = lines_share(panel) ? 0 : panel->model->packed_log2;
    const unsigned first_place = panel->lie.x_reversed ? (unsigned)glass_width - width : 0;
    const unsigned first_byte = first_place >> byte_log2;
    const unsigned end_byte = ((first_place + width - 1U) >> byte_log2) + 1U;
    const size_t half = panel->config.memory_bytes / 2U;
    panel->first_byte = (uint8_t)first_byte;
    panel->unit_bytes = (uint8_t)(end_byte - first_byte);
    panel->capacity = (uint8_t)(half < (size_t)panel->unit_bytes * UINT8_MAX ? half / panel->unit_bytes : UINT8_MAX);
    panel->unit = 0;
    panel->units = 0;
    panel->begun = false;
    panel->moved = false;
    panel->turn = (uint8_t)((panel->turn + 1U) % EL_OLED_WHOLE_FRAMES);
    panel->whole = changed || panel->turn == 0;
    set_bytes(panel, first_byte, end_byte);
    if (!panel->lie.y_reversed) {
        set_units(panel, 0, frame_units(panel));
    }
}

static void rows(void *context, el_band *band, unsigned slot)
{
    el_oled *const panel = context;
    const unsigned last_of_unit = (1U << panel->lines_log2) - 1U;
    for (unsigned line = 0; line < band->lines && panel->fits; line++) {
        const unsigned y = (unsigned)band->y + line;
        uint8_t *const unit = unit_at(panel, panel->filling, panel->units);
        if (!panel->begun) {
            memset(unit, 0, panel->unit_bytes);
        }
        pack_line(panel, unit, band->pixels + (size_t)line * band->width, y);
        panel->begun = ((y + 1U) & last_of_unit) != 0 && y + 1U < panel->height;
        panel->units = (uint8_t)(panel->units + !panel->begun);
        if (panel->units == panel->capacity) {
            flush(panel);
        }
    }
    el_band_release(band, slot);
    if (panel->units > 0) {
        flush(panel);
    }
}

static bool unchanged(void *context, uint16_t y, uint16_t lines)
{
    el_oled *const panel = context;
    const unsigned last_of_unit = (1U << panel->lines_log2) - 1U;
    const unsigned next = (unsigned)y + lines;
    if (!panel->fits) {
        return true;
    }
    if (panel->whole || panel->begun || (y & last_of_unit) != 0 ||
        ((next & last_of_unit) != 0 && next < panel->height)) {
        return false;
    }
    /* `rows` has sent what it had. */
    panel->unit = (uint8_t)(((next - 1U) >> panel->lines_log2) + 1U);
    panel->moved = true;
    return true;
}

static void end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static void wait(void *context)
{
    const el_oled *const panel = context;
    el_panel_wait(panel->config.bus);
}

el_sink el_oled_sink(el_oled *panel)
{
    return (el_sink){.context = panel,
                     .begin = begin,
                     .rows = rows,
                     .unchanged = EL_WITH_REUSE ? unchanged : NULL,
                     .end = end,
                     .wait = wait};
}

/* --- Start -------------------------------------------------------------------------------------------------------- */

static bool is_possible(const el_oled_config *config)
{
    const el_bus *const bus = config->bus;
    return bus != NULL && bus->reset != NULL && bus->command != NULL && bus->bytes != NULL && bus->delay_ms != NULL &&
           config->memory != NULL && el_panel_has_rotation(config->rotation);
}

el_status el_oled_init(el_oled *panel, const el_oled_model *model, const el_oled_config *config)
{
    if (panel == NULL || model == NULL || config == NULL || !is_possible(config)) {
        return EL_ERROR_ARGUMENT;
    }
    *panel = (el_oled){
        .config = *config,
        .model = model,
        .lie = el_panel_orientation(config->rotation, config->mirrored != 0),
    };
    const bool shared = lines_share(panel);
    const unsigned unit_bytes = (unsigned)el_oled_width(panel) >> (shared ? 0 : model->packed_log2);
    panel->lines_log2 = shared ? model->packed_log2 : 0;
    if (config->memory_bytes < (size_t)2 * unit_bytes) {
        return EL_ERROR_MEMORY;
    }
    el_panel_reset(config->bus, model->reset_wait_ms);
    for (size_t i = 0; i < model->start_up_count; i++) {
        send(panel, &model->start_up[i]);
    }
    send(panel, panel->lie.sideways ? &model->along_columns : &model->along_rows);
    send_byte(panel, config->inverted != 0 ? model->show_negative : model->show_positive);
    send_byte(panel, model->display_on);
    return EL_OK;
}
