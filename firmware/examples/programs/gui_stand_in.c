#include "gui_stand_in.h"

#include "canvas/text.h"
#include "paint/fonts/aileron_13.h"

enum { BAR_TOP = 28, BAR_HEIGHT = 12, MARGIN = 8, BACKGROUND = 0x2125, TRACK = 0x4A69, FILL = 0x051F };

void gui_display_flush_ready(gui_display *display)
{
    display->is_flushing = false;
}

/* Lines [y, y_end) of the GUI, in pieces that the buffer holds. */
static void redraw(gui_display *display, int32_t width, int32_t y, int32_t y_end, const char *title, int32_t bar)
{
    const int32_t lines_at_once = (int32_t)display->draw_buf_pixels / width;
    for (; y < y_end; y += lines_at_once) {
        while (display->is_flushing) {
            display->wait_cb(NULL);
        }
        const int32_t end = y_end - y < lines_at_once ? y_end : y + lines_at_once;
        const el_canvas canvas = {.pixels = display->draw_buf, .stride = width, .y = y, .clip = {0, y, width, end}};
        el_canvas_fill(&canvas, canvas.clip, el_solid(BACKGROUND));
        el_canvas_text(&canvas, &aileron_13, MARGIN, 20, EL_ALIGN_LEFT, title, el_solid(0xFFFF));
        const int32_t length = width - 2 * MARGIN;
        el_canvas_fill(&canvas, (el_rect){MARGIN, BAR_TOP, MARGIN + length, BAR_TOP + BAR_HEIGHT}, el_solid(TRACK));
        el_canvas_fill(&canvas, (el_rect){MARGIN, BAR_TOP, MARGIN + length * bar / 100, BAR_TOP + BAR_HEIGHT},
                       el_solid(FILL));
        display->is_flushing = true;
        display->flush_cb(display, &(gui_area){0, y, width - 1, end - 1}, (uint8_t *)display->draw_buf);
    }
}

void gui_refresh(gui_display *display, int32_t width, const char *title, int32_t bar)
{
    if (!display->is_title_shown) {
        redraw(display, width, 0, GUI_HEIGHT, title, bar);
    } else if (bar != display->bar_shown) {
        redraw(display, width, BAR_TOP, BAR_TOP + BAR_HEIGHT, title, bar);
    }
    display->is_title_shown = true;
    display->bar_shown = bar;
}
