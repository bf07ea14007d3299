/* What a call of the public interface can answer: EL_OK, or a negative error. */
#ifndef EL_BASE_STATUS_H
#define EL_BASE_STATUS_H

typedef enum el_status {
    EL_OK = 0,
    EL_ERROR_ARGUMENT = -1, /* a null pointer, or a call in the wrong order */
    EL_ERROR_SIZE = -2,     /* width, height, band lines, texture error, view or a count out of range */
    EL_ERROR_MEMORY = -3,   /* the arena is smaller than the least that the configuration needs */
    EL_ERROR_CAMERA = -4,   /* field of view, aspect, near or far out of range, axes longer than 1, or a
                               projection that base/options.h leaves out */
    EL_ERROR_RANGE = -5,    /* a position, scale or mesh outside +-16384 world units */
    EL_ERROR_MATERIAL = -6  /* the shading asks for what the mesh or the material does not have, or for what
                               base/options.h leaves out */
} el_status;

#endif
