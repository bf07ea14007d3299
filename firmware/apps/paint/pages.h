/* Pages: what canvas/ draws, alone or over a scene, as functions of the frame's number alone. */
#ifndef EL_APPS_PAINT_PAGES_H
#define EL_APPS_PAINT_PAGES_H

#include "edgeline.h"
#include "scene.h"

typedef struct el_page {
    const char *name;
    const char *summary; /* one line */
    const char *scene;   /* what lies below, by el_scene_find; NULL: the background alone */
    uint16_t background; /* RGB565, where there is no scene */
    void (*draw)(uint32_t frame, const el_canvas *canvas); /* for 320 x 240 pixels */
} el_page;

extern const el_page *const el_pages[];
extern const size_t el_page_count;

/* NULL when there is no such page. */
const el_page *el_page_find(const char *name);

/* A page at one of its frames, as the context of el_page_draw, which is an el_layer's. */
typedef struct el_page_frame {
    const el_page *page;
    uint32_t frame;
} el_page_frame;

void el_page_draw(void *page_frame, el_band *band);

#endif
