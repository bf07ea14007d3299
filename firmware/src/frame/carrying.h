/* The memory of triangles that are carried on from band to band (painter.h), and their order. Private to the
 * painters. */
#ifndef EL_FRAME_CARRYING_H
#define EL_FRAME_CARRYING_H

#include "frame/painter.h"

/* What all that is carried begins with. */
typedef struct el_carried {
    uint16_t next;
    uint16_t order; /* name of the record, or of its share in a group */
} el_carried;

/* A state of a kind, which has so many bytes; returns its name, or 0 where there is no memory left. */
static EL_SPECIALISED uint16_t el_carrying_take(el_carrying *c, const el_list *list, el_state_kind kind,
                                                uint32_t state_bytes)
{
    const uint16_t reused = c->given_back[kind];
    if (reused != 0) {
        c->given_back[kind] = *(const uint16_t *)el_list_at(list, reused);
        return reused;
    }
    const uint32_t bytes = EL_LIST_BYTES(state_bytes);
    if (bytes > c->end - c->used) {
        return 0;
    }
    const uint16_t name = (uint16_t)(c->used / EL_LIST_UNIT);
    c->used += bytes;
    return name;
}

static inline void el_carrying_give(el_carrying *c, const el_list *list, el_state_kind kind, uint16_t name)
{
    *(uint16_t *)el_list_at(list, name) = c->given_back[kind];
    c->given_back[kind] = name;
}

/* The place of something carried in the order of submission; 0 of nothing. */
static inline uint16_t el_carrying_order(const el_carrying *c, const el_list *list, uint16_t name)
{
    return !EL_WITH_CARRY || name < c->first_state ? name : ((const el_carried *)el_list_at(list, name))->order;
}

/* Whether the first of two was submitted before the second; nothing is after everything. */
static inline bool el_is_earlier(uint16_t order, uint16_t other)
{
    return order - 1U < other - 1U;
}

/* Takes what was submitted first from the front of the two chains, of which one is not empty: what is listed in this band, and
 * what is carried on from above. Returns its name. */
static inline uint16_t el_carrying_next(const el_carrying *c, const el_list *list, uint16_t *fresh, uint16_t *carried)
{
    uint16_t *const taken = el_is_earlier(*fresh, el_carrying_order(c, list, *carried)) ? fresh : carried;
    const uint16_t listed = *taken;
    *taken = *(const uint16_t *)el_list_at(list, listed);
    return listed;
}

#endif
