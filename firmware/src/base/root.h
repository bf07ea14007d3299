/* Reciprocals of square roots, for directions of length 1: no division, no digit by digit, the same on every core. */
#ifndef EL_BASE_ROOT_H
#define EL_BASE_ROOT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* 2^47 / sqrt(x), off by EL_ROOT_ERROR at most: all x that may be given were tried. Pre: 2^30 <= x. */
enum { EL_ROOT_ERROR = 34 };
uint32_t el_reciprocal_root(uint32_t x);

#ifdef __cplusplus
}
#endif

#endif
