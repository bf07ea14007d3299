/* The list of pages. */
#include "paint/pages.h"

#include <string.h>

#include "paint/page_functions.h"
#include "paint/paint_colours.h"

static const el_page card = {"card", "polygons, lines, shapes, images and text: one of everything", NULL, NIGHT,
                             el_card_draw};
static const el_page lines = {"lines", "lines of all widths, sharp and smooth", NULL, NIGHT, el_lines_draw};
static const el_page horizon = {"horizon", "an attitude indicator with tapes", NULL, BLACK, el_horizon_draw};
static const el_page hud = {"hud", "glass and text over the scene `field`", "field", BLACK, el_hud_draw};

const el_page *const el_pages[] = {&card, &lines, &horizon, &hud};
const size_t el_page_count = sizeof el_pages / sizeof el_pages[0];

const el_page *el_page_find(const char *name)
{
    for (size_t i = 0; i < el_page_count; i++) {
        if (strcmp(el_pages[i]->name, name) == 0) {
            return el_pages[i];
        }
    }
    return NULL;
}

void el_page_draw(void *page_frame, el_band *band)
{
    const el_page_frame *const at = (const el_page_frame *)page_frame;
    const el_canvas canvas = el_canvas_of(band);
    at->page->draw(at->frame, &canvas);
}
