/* What is compiled in. A program that draws with one way of shading need not carry the others: each option set to 0 takes
 * its code out, and what remains draws the same pixels. tests/bench/results/code_size.json has the bytes of each.
 *
 * Set them by -DEL_WITH_TEXTURE=0, by CMake's EDGELINE_WITH_TEXTURE=OFF, or in a header of your own that EL_CONFIG_FILE
 * names, quotes included: -DEL_CONFIG_FILE='"edgeline_config.h"'. The library and the program that uses it are compiled
 * with the same options. A draw or a camera that asks for what was left out gets an error and draws nothing; a member that
 * was left out does not compile. */
#ifndef EL_BASE_OPTIONS_H
#define EL_BASE_OPTIONS_H

#ifdef EL_CONFIG_FILE
#include EL_CONFIG_FILE
#endif

/* Vertex colours: EL_SHADE_GOURAUD, EL_SHADE_TEXTURED_GOURAUD. Without: EL_ERROR_MATERIAL. */
#ifndef EL_WITH_GOURAUD
#define EL_WITH_GOURAUD 1
#endif

/* Textures: EL_SHADE_TEXTURED, EL_SHADE_TEXTURED_GOURAUD. Without: EL_ERROR_MATERIAL. */
#ifndef EL_WITH_TEXTURE
#define EL_WITH_TEXTURE 1
#endif

/* EL_MATERIAL_DITHER. Without: EL_ERROR_MATERIAL. A panel's own dithering (base/dither.h) stays. */
#ifndef EL_WITH_DITHER
#define EL_WITH_DITHER 1
#endif

/* EL_SHADE_OVERDRAW. Without: EL_ERROR_MATERIAL. */
#ifndef EL_WITH_OVERDRAW
#define EL_WITH_OVERDRAW 1
#endif

/* el_material.light. Without: EL_ERROR_MATERIAL where a material has one. */
#ifndef EL_WITH_LIGHT
#define EL_WITH_LIGHT 1
#endif

/* EL_ORTHOGRAPHIC. Without: EL_ERROR_CAMERA. */
#ifndef EL_WITH_ORTHOGRAPHIC
#define EL_WITH_ORTHOGRAPHIC 1
#endif

/* The work counters (base/stats.h). Without, they stay 0. */
#ifndef EL_WITH_STATS
#define EL_WITH_STATS 1
#endif

/* Triangles keep their set-up from band to band. Without, they are set up anew in each: slower where bands are low. */
#ifndef EL_WITH_CARRY
#define EL_WITH_CARRY 1
#endif

/* The debug views, and shadings that are left out at run time (el_config.view, .shading_off): 0 by default. Without:
 * el_init refuses them with EL_ERROR_SIZE, and no frame pays for them. */
#ifndef EL_WITH_DEBUG_VIEWS
#define EL_WITH_DEBUG_VIEWS 0
#endif

/* 1: of two ways to the same pixels the shorter code, as -Os asks for; 0: the faster. */
#ifndef EL_SMALL_CODE
#ifdef __OPTIMIZE_SIZE__
#define EL_SMALL_CODE 1
#else
#define EL_SMALL_CODE 0
#endif
#endif

/* Triangles of a full display list shrink to 8 bytes each. Without, which is what small code begins with, a full list
 * costs passes sooner, and each draw call takes 128 bytes less. */
#ifndef EL_WITH_THIN
#define EL_WITH_THIN (!EL_SMALL_CODE)
#endif

/* Clusters of a mesh (geometry/mesh.h) are skipped as a whole. Without, which is what small code begins with, each of
 * their triangles is looked at. */
#ifndef EL_WITH_CLUSTERS
#define EL_WITH_CLUSTERS (!EL_SMALL_CODE)
#endif

/* What is behind everything that is drawn already is not set up (raster/hidden.h). Without, which is what small code begins
 * with, the depth test finds it pixel by pixel. Needs EL_WITH_STATS, which count how full a band is. */
#ifndef EL_WITH_HIDDEN
#define EL_WITH_HIDDEN (!EL_SMALL_CODE && EL_WITH_STATS)
#endif

/* el_config.depth_prepass. Without, which is what small code begins with: el_init refuses it with EL_ERROR_SIZE. */
#ifndef EL_WITH_PREPASS
#define EL_WITH_PREPASS (!EL_SMALL_CODE)
#endif

/* Several cores for a frame (el_config.workers, frame/workers.h). Without, which is what small code begins with: el_init
 * refuses more than one with EL_ERROR_SIZE. */
#ifndef EL_WITH_WORKERS
#define EL_WITH_WORKERS (!EL_SMALL_CODE)
#endif

/* What the frame before has already is left out: el_config.reuse, el_tft_config.shown. Without, which is what small code
 * begins with: el_init refuses the one with EL_ERROR_SIZE, el_tft_init the other with EL_ERROR_ARGUMENT. */
#ifndef EL_WITH_REUSE
#define EL_WITH_REUSE (!EL_SMALL_CODE)
#endif

/* What is mixed from more than one colour per pixel, and textures of any kind (el_material.alpha, .fog; el_texture.image,
 * .wrap_u, .wrap_v, .smooth). Without, which is what small code begins with, there are no such members. */
#ifndef EL_WITH_MIXED
#define EL_WITH_MIXED (!EL_SMALL_CODE)
#endif

/* el_texture.smaller. Without, which is what small code begins with, there is no such member. */
#ifndef EL_WITH_MIPMAPS
#define EL_WITH_MIPMAPS (!EL_SMALL_CODE && EL_WITH_TEXTURE)
#endif

/* Several samples per pixel. Without, which is what small code begins with, there is no el_config.samples. */
#ifndef EL_WITH_SAMPLES
#define EL_WITH_SAMPLES (!EL_SMALL_CODE)
#endif

/* EL_MATERIAL_WIRES, el_mesh.edges. Without, and small code begins without, there is neither. */
#ifndef EL_WITH_WIRES
#define EL_WITH_WIRES (!EL_SMALL_CODE)
#endif

/* el_config.interlaced. Without, and small code has none, there is no such member. */
#ifndef EL_WITH_INTERLACED
#define EL_WITH_INTERLACED (!EL_SMALL_CODE)
#endif

/* A display's stripes of red, green and blue as pixels side by side. Without, which is what small code begins with, there is no
 * el_config.stripes. */
#ifndef EL_WITH_STRIPES
#define EL_WITH_STRIPES (!EL_SMALL_CODE)
#endif

#if (EL_WITH_GOURAUD | EL_WITH_TEXTURE | EL_WITH_DITHER | EL_WITH_OVERDRAW | EL_WITH_LIGHT | EL_WITH_ORTHOGRAPHIC |    \
     EL_WITH_STATS | EL_WITH_CARRY | EL_WITH_THIN | EL_WITH_CLUSTERS | EL_WITH_HIDDEN | EL_WITH_PREPASS |              \
     EL_WITH_WORKERS | EL_WITH_REUSE | EL_WITH_MIXED | EL_WITH_MIPMAPS | EL_WITH_SAMPLES | EL_WITH_WIRES |             \
     EL_WITH_INTERLACED | EL_WITH_STRIPES | EL_WITH_DEBUG_VIEWS) &                                                     \
    ~1
#error "each EL_WITH_ option is 0 or 1"
#endif
#if EL_WITH_HIDDEN && !EL_WITH_STATS
#error "EL_WITH_HIDDEN needs EL_WITH_STATS"
#endif
#if EL_WITH_INTERLACED && EL_SMALL_CODE
#error "EL_WITH_INTERLACED is not for small code"
#endif
#if EL_WITH_MIPMAPS && !EL_WITH_TEXTURE
#error "EL_WITH_MIPMAPS needs EL_WITH_TEXTURE"
#endif
#if EL_WITH_DEBUG_VIEWS && !(EL_WITH_OVERDRAW && EL_WITH_STATS)
#error "EL_WITH_DEBUG_VIEWS counts pixels and work: it needs EL_WITH_OVERDRAW and EL_WITH_STATS"
#endif

/* Functions of headers: a copy of its own for each file that calls them, to be merged with the caller; or, in small code,
 * one for the program, which the header's source file holds: EL_INLINE_HERE with the function's declaration. */
#if EL_SMALL_CODE
#define EL_INLINE inline
#define EL_INLINE_HERE extern inline
#else
#define EL_INLINE static inline
#define EL_INLINE_HERE static inline
#endif

/* Functions that are called rarely, from where speed counts: never merged with their callers. */
#define EL_SELDOM __attribute__((noinline, cold))

/* Functions that are kept apart where speed counts, so that what is rare takes no registers from what is frequent; in small
 * code they are merged where that is shorter. */
#if EL_SMALL_CODE
#define EL_APART
#else
#define EL_APART __attribute__((noinline))
#endif

/* Functions that small code keeps apart, though they are called from one place, because that is shorter. */
#if EL_SMALL_CODE
#define EL_APART_IF_SMALL __attribute__((noinline))
#else
#define EL_APART_IF_SMALL
#endif

/* Functions that are compiled anew into each caller, with what is known there, where speed counts. */
#if EL_SMALL_CODE
#define EL_SPECIALISED inline
#else
#define EL_SPECIALISED inline __attribute__((always_inline))
#endif

/* What is made up to here is not made in another way. */
#if defined(__thumb__) || defined(__riscv)
#define EL_SETTLE(value) __asm__("" : "+r"(value))
#else
#define EL_SETTLE(value) ((void)(value))
#endif

#endif
