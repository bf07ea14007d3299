/* Polygons row by row: the crossings of a row with the outline, from left to right, bound its spans.
 *
 * A crossing is kept as the first column whose centre is not left of it. Crossings of one column have no centre between
 * them, so their order does not matter, and half-open spans decide centres on the outline as left and top edges do. */
#include "methods/polygons.h"

typedef struct crossing {
    int32_t column;
    int32_t turn; /* +1 for an edge that goes down, -1 for one that goes up */
} crossing;

/* Fills the row where the turns on the left make an inside. */
static uint32_t fill_row(const crossing *crossings, size_t count, el_fill_rule rule, int32_t row, el_hits *hits)
{
    uint32_t written = 0;
    int32_t turns = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        turns += crossings[i].turn;
        /* After an odd number of crossings the sum of their turns is odd. */
        if (rule == EL_FILL_EVEN_ODD ? (turns & 1) != 0 : turns != 0) {
            written += el_hit_span(hits, row, crossings[i].column, crossings[i + 1].column);
        }
    }
    return written;
}

/* --- All edges ---------------------------------------------------------------------------------------------------- */

uint32_t el_polygon_scanline(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    const el_box box = el_box_of_polygon(polygon, hits);
    uint32_t written = 0;
    for (int32_t row = box.y; row < box.y_end; row++) {
        const int32_t y = el_centre_of(0, row).y;
        crossing crossings[EL_POLYGON_EDGES];
        size_t count = 0;
        for (size_t i = 0; i < polygon->edge_count; i++) {
            const el_spot a = polygon->edges[i].a;
            const el_spot b = polygon->edges[i].b;
            if ((a.y <= y) == (b.y <= y)) {
                continue;
            }
            const crossing found = {el_crossing_column(a, b, row), a.y < b.y ? 1 : -1};
            size_t place = count++;
            for (; place > 0 && crossings[place - 1].column > found.column; place--) {
                crossings[place] = crossings[place - 1];
            }
            crossings[place] = found;
        }
        written += fill_row(crossings, count, rule, row, hits);
    }
    return written;
}

/* --- Edge table and active edge table ----------------------------------------------------------------------------- */

typedef struct table_edge {
    el_rows rows;
    el_edge walk; /* its crossing with the row under way, stepped exactly */
    int32_t turn;
} table_edge;

/* The edges that pass a row of the picture, by their first row, each ready for that row. Returns how many. */
static size_t make_edge_table(const el_polygon *polygon, int32_t rows, table_edge table[EL_POLYGON_EDGES])
{
    size_t count = 0;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const el_spot a = polygon->edges[i].a;
        const el_spot b = polygon->edges[i].b;
        table_edge edge = {.rows = el_rows_of_edge(a, b, rows), .turn = a.y < b.y ? 1 : -1};
        if (edge.rows.y >= edge.rows.y_end) {
            continue;
        }
        const el_spot top = a.y < b.y ? a : b;
        const el_spot bottom = a.y < b.y ? b : a;
        el_edge_make(&edge.walk, top.x, top.y, bottom.x, bottom.y, edge.rows.y);
        size_t place = count++;
        for (; place > 0 && table[place - 1].rows.y > edge.rows.y; place--) {
            table[place] = table[place - 1];
        }
        table[place] = edge;
    }
    return count;
}

uint32_t el_polygon_active_edges(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    table_edge table[EL_POLYGON_EDGES];
    const size_t table_count = make_edge_table(polygon, hits->height, table);
    table_edge *active[EL_POLYGON_EDGES];
    size_t active_count = 0;
    size_t next = 0;
    uint32_t written = 0;
    for (int32_t row = table_count > 0 ? table[0].rows.y : 0; active_count > 0 || next < table_count; row++) {
        for (; next < table_count && table[next].rows.y == row; next++) {
            active[active_count++] = &table[next];
        }
        /* From row to row the order changes little: only where edges cross or begin. */
        for (size_t i = 1; i < active_count; i++) {
            table_edge *const moved = active[i];
            size_t place = i;
            for (; place > 0 && el_edge_x(&active[place - 1]->walk) > el_edge_x(&moved->walk); place--) {
                active[place] = active[place - 1];
            }
            active[place] = moved;
        }
        crossing crossings[EL_POLYGON_EDGES];
        size_t kept = 0;
        for (size_t i = 0; i < active_count; i++) {
            crossings[i] = (crossing){el_edge_x(&active[i]->walk), active[i]->turn};
        }
        written += fill_row(crossings, active_count, rule, row, hits);
        for (size_t i = 0; i < active_count; i++) {
            if (active[i]->rows.y_end > row + 1) {
                el_edge_next_row(&active[i]->walk);
                active[kept++] = active[i];
            }
        }
        active_count = kept;
    }
    return written;
}
