/* A GUI library of the usual shape, for flush_callback.c: it draws what has changed into a small buffer, piece by piece,
 * and hands each piece to a callback of the program's, which sends it and says when the buffer is free. LVGL 9 has the
 * same three: lv_display_set_buffers, lv_display_set_flush_cb, lv_display_flush_ready.
 *
 * It knows two widgets: a title, and a bar that shows 0..100. */
#ifndef EL_EXAMPLE_GUI_STAND_IN_H
#define EL_EXAMPLE_GUI_STAND_IN_H

#include <stdbool.h>
#include <stdint.h>

/* Both ends are in it, as LVGL has it. */
typedef struct gui_area {
    int32_t x1, y1, x2, y2;
} gui_area;

typedef struct gui_display {
    uint16_t *draw_buf;       /* the caller's */
    uint32_t draw_buf_pixels; /* at least a line of the widest widget */
    void (*flush_cb)(struct gui_display *display, const gui_area *area, uint8_t *px_map);
    void (*wait_cb)(void *context); /* called with NULL while the buffer is not free */
    volatile bool is_flushing;      /* the GUI's, as those below */
    bool is_title_shown;
    int32_t bar_shown;
} gui_display;

/* What flush_cb has sent is sent; from an interrupt too. */
void gui_display_flush_ready(gui_display *display);

/* Draws what has changed since the last call. The screen is width pixels wide; the widgets take its upper GUI_HEIGHT
 * lines. */
enum { GUI_HEIGHT = 48 };
void gui_refresh(gui_display *display, int32_t width, const char *title, int32_t bar);

#endif
