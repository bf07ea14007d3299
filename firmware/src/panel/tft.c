#include "panel/tft.h"

#include <stddef.h>

#include "base/options.h"

/* Commands: data sheets of ILI9341 (V1.11), ST7789V (V1.3) and ST7735 (V1.7), which agree about these. */
enum {
    CMD_SLEEP_OUT = 0x11,      /* 8.2.12; 9.1.12; 10.1.11 */
    CMD_INVERSION_OFF = 0x20,  /* 8.2.15; 9.1.15; 10.1.14 */
    CMD_INVERSION_ON = 0x21,   /* 8.2.16; 9.1.16; 10.1.15 */
    CMD_DISPLAY_ON = 0x29,     /* 8.2.19; 9.1.19; 10.1.18 */
    CMD_COLUMN_ADDRESS = 0x2A, /* 8.2.20; 9.1.20; 10.1.19 */
    CMD_ROW_ADDRESS = 0x2B,    /* 8.2.21; 9.1.21; 10.1.20 */
    CMD_MEMORY_WRITE = 0x2C,   /* 8.2.22; 9.1.22; 10.1.21 */
    CMD_MEMORY_ACCESS = 0x36,  /* 8.2.29; 9.1.28; 10.1.26 */
    CMD_SCROLL_AREA = 0x33,    /* 8.2.26; 9.1.25; none */
    CMD_SCROLL_START = 0x37    /* 8.2.30; 9.1.29; none */
};

enum {
    RESET_WAIT_MS = 120, /* 5 ms, or 120 ms before SLEEP OUT if the panel was awake; sections 15.4; 7.4.5; 9.16 */
    SLEEP_OUT_MS = 120,  /* 5 ms before the next command, 120 ms before the panel's voltages are there */

    NO_LINE = 0xFFFF, /* the frame has no window yet */
    BLACK_PIXELS = 64
};

uint16_t el_tft_width(const el_tft *panel)
{
    return panel->lie.sideways ? panel->config.model->rows : panel->config.model->columns;
}

uint16_t el_tft_height(const el_tft *panel)
{
    return panel->lie.sideways ? panel->config.model->columns : panel->config.model->rows;
}

static void send(const el_bus *bus, uint8_t code, const uint8_t *parameters, size_t count)
{
    bus->command(bus->context, code, parameters, count);
}

static void send_entry(const el_bus *bus, const el_tft_command *command)
{
    send(bus, command->code, command->parameters, command->count);
}

/* MX and MY belong to the memory's columns and rows, whichever of them are the viewer's x and y. */
static uint8_t memory_access(const el_tft *panel)
{
    const el_orientation lie = panel->lie;
    uint8_t access = panel->config.model->access;
    if (lie.sideways) {
        access ^= EL_TFT_ACCESS_MV;
    }
    if (lie.sideways ? lie.y_reversed : lie.x_reversed) {
        access ^= EL_TFT_ACCESS_MX;
    }
    if (lie.sideways ? lie.x_reversed : lie.y_reversed) {
        access ^= EL_TFT_ACCESS_MY;
    }
    if (panel->config.rgb_order) {
        access ^= EL_TFT_ACCESS_BGR;
    }
    return access;
}

/* Where the glass begins: addresses count from the other end of the memory where the walk is reversed. */
static void place_glass(el_tft *panel, uint8_t access)
{
    const el_tft_model *const model = panel->config.model;
    const uint16_t column = (access & EL_TFT_ACCESS_MX) != 0
                                ? (uint16_t)(model->memory_columns - model->first_column - model->columns)
                                : model->first_column;
    const uint16_t row = (access & EL_TFT_ACCESS_MY) != 0
                             ? (uint16_t)(model->memory_rows - model->first_row - model->rows)
                             : model->first_row;
    panel->first_x = panel->lie.sideways ? row : column;
    panel->first_y = panel->lie.sideways ? column : row;
}

static void choose_transfer(el_tft *panel)
{
    const el_bus *const bus = panel->config.bus;
    const bool high_first = panel->config.byte_order == EL_HIGH_BYTE_FIRST;
    const bool memory_high_first = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
    panel->words = bus->pixels != NULL && (high_first || bus->bytes == NULL);
    panel->swap = high_first != (panel->words || memory_high_first); /* words go high byte first */
}

static bool is_possible(const el_tft_config *config)
{
    const el_bus *const bus = config->bus;
    return bus != NULL && bus->reset != NULL && bus->command != NULL && bus->delay_ms != NULL &&
           (bus->pixels != NULL || bus->bytes != NULL) && config->model != NULL &&
           el_panel_has_rotation(config->rotation) && (EL_WITH_REUSE || config->shown == NULL) &&
           (config->byte_order == EL_HIGH_BYTE_FIRST ||
            (config->byte_order == EL_LOW_BYTE_FIRST && config->model->low_byte_first != NULL));
}

el_status el_tft_init(el_tft *panel, const el_tft_config *config)
{
    if (panel == NULL || config == NULL || !is_possible(config)) {
        return EL_ERROR_ARGUMENT;
    }
    const el_bus *const bus = config->bus;
    const el_tft_model *const model = config->model;
    *panel = (el_tft){
        .config = *config, .lie = el_panel_orientation(config->rotation, config->mirrored != 0), .stale = true};
    if (EL_WITH_REUSE && config->shown != NULL &&
        config->shown_bytes < EL_TFT_SHOWN_BYTES(el_tft_width(panel), el_tft_height(panel))) {
        return EL_ERROR_MEMORY;
    }
    const uint8_t access = memory_access(panel);
    place_glass(panel, access);
    choose_transfer(panel);

    el_panel_reset(bus, RESET_WAIT_MS);
    for (size_t i = 0; i < model->start_up_count; i++) {
        send_entry(bus, &model->start_up[i]);
    }
    if (config->byte_order == EL_LOW_BYTE_FIRST) {
        send_entry(bus, model->low_byte_first);
    }
    send(bus, CMD_MEMORY_ACCESS, &access, 1);
    send(bus, (model->inverted != 0) != (config->inverted != 0) ? CMD_INVERSION_ON : CMD_INVERSION_OFF, NULL, 0);
    send(bus, CMD_SLEEP_OUT, NULL, 0);
    bus->delay_ms(bus->context, SLEEP_OUT_MS);
    send(bus, CMD_DISPLAY_ON, NULL, 0);
    return EL_OK;
}

void el_tft_forget(el_tft *panel)
{
    panel->stale = true;
}

/* The controller moves rows of its memory, whichever of them are the viewer's first, and counts all that it has. */
el_status el_tft_scroll(el_tft *panel, uint16_t first, uint16_t end, uint16_t by)
{
    const el_tft_model *const model = panel->config.model;
    if (!model->scrolls) {
        return EL_ERROR_ARGUMENT;
    }
    if (first >= end || end > model->rows || by >= end - first) {
        return EL_ERROR_SIZE;
    }
    const el_bus *const bus = panel->config.bus;
    const bool reversed = (memory_access(panel) & EL_TFT_ACCESS_MY) != 0;
    const unsigned rows = (unsigned)end - first;
    const unsigned top = model->first_row + (reversed ? (unsigned)model->rows - end : first);
    const unsigned bottom = model->memory_rows - top - rows;
    const unsigned start = top + (reversed && by > 0 ? rows - by : by);
    const uint8_t area[6] = {(uint8_t)(top >> 8), (uint8_t)top,           (uint8_t)(rows >> 8),
                             (uint8_t)rows,       (uint8_t)(bottom >> 8), (uint8_t)bottom};
    const uint8_t line[2] = {(uint8_t)(start >> 8), (uint8_t)start};
    send(bus, CMD_SCROLL_AREA, area, sizeof area);
    send(bus, CMD_SCROLL_START, line, sizeof line);
    panel->next_line = NO_LINE; /* no pixel goes on where the last one was */
    return EL_OK;
}

static void set_range(const el_bus *bus, uint8_t code, unsigned begin, unsigned end)
{
    /* The controller's ranges include their last element. */
    const unsigned last = end - 1U;
    const uint8_t range[4] = {(uint8_t)(begin >> 8), (uint8_t)begin, (uint8_t)(last >> 8), (uint8_t)last};
    send(bus, code, range, sizeof range);
}

static void set_columns(const el_tft *panel, unsigned left, unsigned right)
{
    set_range(panel->config.bus, CMD_COLUMN_ADDRESS, panel->first_x + left, panel->first_x + right);
}

static void start_writing(const el_tft *panel, unsigned line, unsigned height)
{
    set_range(panel->config.bus, CMD_ROW_ADDRESS, panel->first_y + line, panel->first_y + height);
    send(panel->config.bus, CMD_MEMORY_WRITE, NULL, 0);
}

static void send_pixels(const el_tft *panel, const uint16_t *pixels, size_t count, void (*done)(void *argument),
                        void *argument)
{
    const el_bus *const bus = panel->config.bus;
    if (panel->words) {
        bus->pixels(bus->context, pixels, count, done, argument);
    } else {
        bus->bytes(bus->context, (const uint8_t *)pixels, count * sizeof pixels[0], done, argument);
    }
}

static void nothing_to_release(void *argument)
{
    (void)argument;
}

/* The memory holds noise after power-on; what a smaller frame leaves free would show it for ever. */
static void blacken(const el_tft *panel)
{
    static const uint16_t black[BLACK_PIXELS];
    const unsigned width = el_tft_width(panel);
    const unsigned height = el_tft_height(panel);
    set_columns(panel, 0, width);
    start_writing(panel, 0, height);
    for (size_t left = (size_t)width * height; left > 0;) {
        const size_t count = left < BLACK_PIXELS ? left : BLACK_PIXELS;
        send_pixels(panel, black, count, nothing_to_release, NULL);
        left -= count;
    }
}

/* Of a frame that begins: all of it, or its next few lines and what is not shown yet. */
static void choose_what_is_sent(el_tft *panel, bool all)
{
    panel->pixels_kept = 0;
    panel->whole = panel->stale || all;
    panel->stale = false;
    panel->refresh = (uint16_t)(panel->refresh + EL_TFT_REFRESH_LINES);
    if (panel->refresh >= panel->height) {
        panel->refresh = 0;
    }
}

static void begin(void *context, uint16_t width, uint16_t height)
{
    el_tft *const panel = context;
    const uint16_t glass_width = el_tft_width(panel);
    const uint16_t glass_height = el_tft_height(panel);
    const bool changed = width != panel->width || height != panel->height;
    panel->fits = width <= glass_width && height <= glass_height;
    if (panel->fits && changed && (width < glass_width || height < glass_height)) {
        blacken(panel);
    }
    panel->width = width;
    panel->height = height;
    panel->next_line = NO_LINE;
    if (EL_WITH_REUSE) {
        choose_what_is_sent(panel, changed);
    }
}

static void swap_bytes(uint16_t *pixels, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        pixels[i] = (uint16_t)(pixels[i] << 8 | pixels[i] >> 8);
    }
}

static void sent(void *argument)
{
    const struct el_tft_loan *const loan = argument;
    el_band_release(loan->band, loan->slot);
}

/* The bus may still be sending the other band, so each has its own entry. */
static struct el_tft_loan *take_loan(el_tft *panel, el_band *band, unsigned slot)
{
    struct el_tft_loan *const loan = &panel->loans[panel->next_loan];
    panel->next_loan ^= 1U;
    *loan = (struct el_tft_loan){.band = band, .slot = slot};
    return loan;
}

/* The lines of a band, counted from its first, that are sent whatever they show; empty where top is not above bottom. */
static void find_due(const el_tft *panel, unsigned y, unsigned lines, unsigned *top, unsigned *bottom)
{
    const unsigned end = (unsigned)panel->refresh + EL_TFT_REFRESH_LINES;
    *top = panel->whole || panel->refresh < y ? 0 : panel->refresh - y;
    *bottom = panel->whole || end >= y + lines ? lines : (end > y ? end - y : 0);
}

/* What of a band is sent. */
static el_shown_part find_part(const el_tft *panel, const el_band *band)
{
    if (!EL_WITH_REUSE || panel->config.shown == NULL) {
        return (el_shown_part){.right = band->width, .bottom = band->lines};
    }
    uint32_t *const hashes = panel->config.shown + (size_t)band->y * EL_SHOWN_SEGMENTS(band->width);
    el_shown_part part = el_shown_update(hashes, band->pixels, band->width, band->lines);
    unsigned top;
    unsigned bottom;
    find_due(panel, band->y, band->lines, &top, &bottom);
    if (top < bottom) {
        el_shown_add_lines(&part, band->width, top, bottom);
    }
    return part;
}

/* A window reaches to the frame's last line, so that a part below the last one, with the same columns, continues it without
 * a command. Windows do not outlive a frame: a display that was disturbed takes the next one's. */
static void set_window(el_tft *panel, unsigned y, const el_shown_part *part)
{
    const bool same_columns = !EL_WITH_REUSE || (part->left == panel->left && part->right == panel->right);
    if (panel->next_line == NO_LINE || !same_columns) {
        set_columns(panel, part->left, part->right);
        panel->left = part->left;
        panel->right = part->right;
        panel->next_line = NO_LINE;
    }
    if (y + part->top != panel->next_line) {
        start_writing(panel, y + part->top, panel->height);
    }
    panel->next_line = (uint16_t)(y + part->bottom);
}

/* Of an interlaced frame: a window for each line, of 6 bytes, since its columns are set once. What is on the glass is of two
 * frames then, so the next one without gaps is sent whole. */
static EL_SELDOM void send_lines(el_tft *panel, el_band *band, struct el_tft_loan *loan)
{
    const el_shown_part line = {.right = band->width, .bottom = 1};
    if (panel->swap) {
        swap_bytes(band->pixels, (size_t)band->lines * band->width);
    }
    for (unsigned i = 0; i < band->lines; i++) {
        const bool is_last = i + 1U == band->lines;
        set_window(panel, band->y + i * (1U + band->gap), &line);
        send_pixels(panel, band->pixels + (size_t)i * band->width, band->width, is_last ? sent : nothing_to_release,
                    loan);
    }
    panel->stale = true;
}

static void rows(void *context, el_band *band, unsigned slot)
{
    el_tft *const panel = context;
    if (!panel->fits) {
        el_band_release(band, slot);
        return;
    }
    if (band->gap != 0) {
        send_lines(panel, band, take_loan(panel, band, slot));
        return;
    }
    const el_shown_part part = find_part(panel, band);
    const size_t count = ((size_t)part.right - part.left) * ((size_t)part.bottom - part.top);
    if (EL_WITH_REUSE) {
        panel->pixels_kept += (uint32_t)((size_t)band->lines * band->width - count);
        if (count == 0) {
            el_band_release(band, slot);
            return;
        }
    }
    struct el_tft_loan *const loan = take_loan(panel, band, slot);
    uint16_t *const pixels = EL_WITH_REUSE ? el_shown_pack(band->pixels, band->width, &part) : band->pixels;
    if (panel->swap) {
        swap_bytes(pixels, count);
    }
    set_window(panel, band->y, &part); /* waits for the band on its way, so it comes last */
    send_pixels(panel, pixels, count, sent, loan);
}

/* One long transfer more or less is not seen in a picture that stands still, so that is sent whole from time to time; one
 * that moves would stumble. */
static bool unchanged(void *context, uint16_t y, uint16_t lines)
{
    el_tft *const panel = context;
    if (!panel->fits) {
        return true;
    }
    if (lines == panel->height && !panel->whole) {
        panel->still = (uint8_t)((panel->still + 1U) % EL_TFT_STILL_FRAMES);
        panel->whole = panel->still == 0;
    }
    unsigned top;
    unsigned bottom;
    find_due(panel, y, lines, &top, &bottom);
    if (panel->whole || (top < bottom && lines < panel->height)) {
        return false;
    }
    panel->pixels_kept += (uint32_t)lines * panel->width;
    return true;
}

static void end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static void wait(void *context)
{
    const el_tft *const panel = context;
    el_panel_wait(panel->config.bus);
}

el_sink el_tft_sink(el_tft *panel)
{
    return (el_sink){.context = panel,
                     .begin = begin,
                     .rows = rows,
                     .unchanged = EL_WITH_REUSE ? unchanged : NULL,
                     .end = end,
                     .wait = wait,
                     .takes_gaps = true};
}
