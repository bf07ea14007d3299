/* The scores as text: a table to read, JSON, CSV. */
#ifndef EL_METHODS_TABLES_H
#define EL_METHODS_TABLES_H

#include <stdio.h>

#include "methods/score.h"

extern const char *const el_edge_rule_names[]; /* by el_edge_rule */
extern const char *const el_fill_rule_names[]; /* by el_fill_rule */
extern const char *const el_value_use_names[]; /* by EL_VALUE_DEPTH, EL_VALUE_COLOUR */

/* What to read: all kinds together, times for some of them. */
void el_table_print(const el_scores *scores, FILE *stream);

/* Everything, as one object:
 *
 *     {"seed", "count", "width", "height",
 *      "triangles": [{"method", "title", "rule", "numbers", "exact",
 *                     "kinds": {KIND: {"shapes", "ns_per_shape", "work", "covered", "edge_pixels", "missing", "extra"}},
 *                     "fans": {"fans", "inner", "cracks", "double_hits"}}],
 *      "polygons": the same without "fans",
 *      "values": [{"use", "method", "title", "numbers",
 *                  "kinds": {KIND: {"triangles", "pixels", "ns_per_pixel", "off", "outside", "max_error", "mean_error"}}}]} */
void el_table_write_json(const el_scores *scores, FILE *stream);

/* One line per method and kind, one header; columns that a family does not have are empty. */
void el_table_write_csv(const el_scores *scores, FILE *stream);

#endif
