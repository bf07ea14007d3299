/* The renderer: frames made of passes, passes made of bands.
 *
 *     el_frame_begin(&r, &camera);
 *     do {
 *         el_draw(&r, &mesh, &pose, &material);
 *     } while (el_frame_next(&r) > 0);
 *
 * A pass collects the triangles of as many bands as the arena has room for, draws them band by band and hands the bands
 * to the sinks. When the list fills up while it is being collected, it keeps 8 bytes per triangle from then on; when that
 * is too much as well, the pass gives up its lower bands, which a further pass draws; the caller's loop submits the scene
 * again. A pass of one band cannot shrink: it draws what it has into the band and goes on collecting. So every frame gets
 * drawn, in any arena that el_init accepts, with the same pixels: which triangle wins a pixel depends on depth and order
 * of submission alone. */
#ifndef EL_FRAME_RENDERER_H
#define EL_FRAME_RENDERER_H

#include <stddef.h>
#include <stdint.h>

#include "base/layer.h"
#include "base/sink.h"
#include "base/stats.h"
#include "base/status.h"
#include "frame/debug_view.h"
#include "frame/painter.h"
#include "frame/workers.h"
#include "geometry/mesh.h"
#include "geometry/pose.h"
#include "geometry/transform.h"
#include "raster/list.h"
#include "raster/material.h"
#include "raster/sample_memory.h"
#include "raster/stripes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes that one listed triangle takes, flat or Gouraud and textured, and a vertex while its mesh is drawn. */
#if EL_SUBPIXEL_BITS == 4
#define EL_TRIANGLE_BYTES 24
#define EL_TEXTURED_TRIANGLE_BYTES 32
#define EL_VERTEX_BYTES 10
#else
#define EL_TRIANGLE_BYTES 48
#define EL_TEXTURED_TRIANGLE_BYTES 56
#define EL_VERTEX_BYTES 16
#endif

enum {
    /* Room for a draw call, a cut triangle and a few vertices at a time. */
    EL_MIN_LIST_BYTES = EL_WITH_THIN ? 704 : 512,
    /* A draw call's; 8 for each change between whole and cut triangles come to it. */
    EL_RUN_BYTES = EL_WITH_THIN ? 160 : 32,
    /* What the renderer knows of a core beside the caller's. */
    EL_PAINTER_BYTES = 352
};

#define EL_ROUND_UP_8(bytes) (((bytes) + 7U) / 8U * 8U)
#define EL_MAX_OF(a, b) ((a) > (b) ? (a) : (b))
/* Two colour bands, the depth band, and the bins of a screen. */
#define EL_COLOUR_BAND_BYTES(width, band_lines) EL_ROUND_UP_8(2U * (width) * (band_lines))
#define EL_DEPTH_BAND_BYTES(width, band_lines) EL_ROUND_UP_8(2U * (width) * (band_lines))
#define EL_BIN_BYTES(height, band_lines) EL_ROUND_UP_8(2U * (((height) + (band_lines)-1U) / (band_lines)))

/* An arena in which a frame of `draws` draw calls of meshes of at most `vertices` vertices each, with `triangles` visible
 * textured triangles in all, takes one pass (24/32 of that for triangles without textures). A triangle that is cut at the
 * near or far plane or the guard band counts for up to seven of three times the size; few are. A third of the room for
 * triangles takes one pass too, but their vertices are transformed twice then, and more often where little is left. While
 * triangles are collected the vertices lie in the depth band, which is not in use then, and beside it where that is too
 * small. Less memory costs passes, never pixels. Never less than el_init accepts. */
#define EL_MEMORY_BYTES(width, height, band_lines, vertices, triangles, draws)                                         \
    EL_MAX_OF(EL_MIN_MEMORY_BYTES(width, height, band_lines),                                                          \
              2U * EL_COLOUR_BAND_BYTES(width, band_lines) + EL_BIN_BYTES(height, band_lines) +                        \
                  EL_MAX_OF(EL_DEPTH_BAND_BYTES(width, band_lines), EL_ROUND_UP_8((vertices)*EL_VERTEX_BYTES)) +       \
                  (triangles)*EL_TEXTURED_TRIANGLE_BYTES + (draws)*EL_RUN_BYTES + EL_MIN_LIST_BYTES / 2U + 16U)

/* The least that el_init accepts. */
#define EL_MIN_MEMORY_BYTES(width, height, band_lines)                                                                 \
    (2U * EL_COLOUR_BAND_BYTES(width, band_lines) + EL_BIN_BYTES(height, band_lines) +                                 \
     EL_DEPTH_BAND_BYTES(width, band_lines) + EL_MIN_LIST_BYTES + 8U)

/* What comes to either of the two with `workers` cores: for each core but the first two colour bands and bins, and for
 * each two depth bands in place of one for all, since a band's depth must last until the sinks have got it. Vertices
 * have all depth bands then. Each triangle takes 8 bytes more for every further EL_GROUP_BANDS bands that it
 * reaches. */
#define EL_WORKERS_BYTES(width, height, band_lines, workers)                                                           \
    ((workers) < 2U ? 0U                                                                                               \
                    : ((workers)-1U) * (2U * EL_COLOUR_BAND_BYTES(width, band_lines) + EL_PAINTER_BYTES +              \
                                        EL_BIN_BYTES(height, band_lines)) +                                            \
                          (2U * (workers)-1U) * EL_DEPTH_BAND_BYTES(width, band_lines))

/* What comes to it with 4 or 8 samples per pixel, for each core: four bytes for each sample of a band, and a bit for each
 * pixel. */
#define EL_SAMPLES_BYTES(width, band_lines, samples)                                                                   \
    ((samples) < 2U ? 0U                                                                                               \
                    : EL_ROUND_UP_8(4U * EL_MIXED_WORDS(width) * (band_lines)) +                                       \
                          EL_ROUND_UP_8(4U * (samples) * (width) * (band_lines)))

/* A display's stripes. With those, all of the above is for this width; the width itself is 1..EL_MAX_STRIPED. */
typedef enum el_stripes { EL_STRIPES_NONE, EL_STRIPES_RGB, EL_STRIPES_BGR, EL_STRIPES_COUNT } el_stripes;

enum { EL_MAX_STRIPED = (int)EL_MAX_WIDTH / (int)EL_STRIPES_PER_PIXEL };
#define EL_STRIPED_WIDTH(width) (EL_STRIPES_PER_PIXEL * (width))

/* What of the frame before need not be made again; bits of el_config.reuse. The renderer's sinks must get frames from no
 * other one, and only sinks that can do without unchanged lines (el_sink.unchanged) save anything. */
enum {
    /* Bands without a triangle, in the frame before too, are neither cleared nor handed over. */
    EL_REUSE_BACKGROUND = 1,
    /* A frame whose camera, meshes, poses and materials are those of the frame before is not drawn. To find that out takes
     * a pass of its own, in which el_draw looks only at what it is given: the values of structures (el_mesh, el_material,
     * el_texture, el_light ...), but not the arrays that they name. A program that changes vertices or texels in place
     * says so by el_frame_forget. Two frames are taken for the same by mistake with a probability of 2^-32. */
    EL_REUSE_FRAME = 2,
    EL_REUSES = EL_WITH_REUSE ? 3 : 0 /* what el_config.reuse may have */
};

/* What its pointers name must outlive the renderer. */
typedef struct el_config {
    uint16_t width;        /* pixels, 1..EL_MAX_WIDTH */
    uint16_t height;       /* lines, 1..EL_MAX_HEIGHT */
    uint16_t band_lines;   /* lines per band, 1..height */
    uint16_t background;   /* RGB565; may be changed in the renderer between frames; so may be the next four */
    uint8_t uv_error_log2; /* texture coordinates are within 2^-uv_error_log2 texels, 1..5; for el_init 0 is 3, 1/8 */
    uint8_t view;          /* el_debug_view */
    uint8_t shading_off;   /* bits of el_shading that no surface uses, see debug_view.h */
    uint8_t reuse;         /* EL_REUSE_, 0: every frame is made anew */
    /* Samples per pixel: 0 or 1, 4 or 8 (raster/samples.h): edges are smooth, inside of triangles nothing changes. A
     * pixel has its depth once for each triangle: where two pass through each other they meet as they do without. May be
     * changed between frames to what needs no more memory than there was for el_init. With several samples there is no
     * depth pre-pass and no EL_SHADE_OVERDRAW, hidden triangles are found pixel by pixel, and each triangle is set up in each
     * band; a debug view shows the frame without. */
#if EL_WITH_SAMPLES
    uint8_t samples;
#endif
    /* Each frame draws, and hands to the sinks, every other line alone, the even and the odd ones by turns: half of the
     * wire, and of the pixels, for a picture that moves twice as smoothly over a slow wire. Two frames of what stands still
     * make the whole picture, to the last bit. For sinks that take gaps (el_sink.takes_gaps); with one sample, one worker and
     * without `stripes`, `reuse`, `depth_prepass` and `view`. */
#if EL_WITH_INTERLACED
    bool interlaced;
#endif
    /* el_stripes, for good: the display's stripes from left to right, in thirds of a pixel (raster/stripes.h). The frame is drawn
     * as one of EL_STRIPED_WIDTH(width) pixels a line: it takes the memory of that, and about the time. Goes with `samples`, of
     * which each stripe has as many. `over` is drawn sharp, `under` and a debug view are filtered like the rest. */
#if EL_WITH_STRIPES
    uint8_t stripes;
#endif
    bool depth_prepass;  /* draw the depth of each band first, so that every pixel is shaded once: where shading is dear
                              and much lies behind other things; may be changed between frames too */
    void *memory;        /* the arena, the renderer's until the last frame is done; any alignment */
    size_t memory_bytes; /* at least EL_MIN_MEMORY_BYTES, and EL_SAMPLES_BYTES for each core */
    const el_sink *sinks[EL_MAX_SINKS]; /* where bands go; NULL where there is none */
    /* Drawn into each band before its triangles and after them (after a debug view, too). NULL: none. What is exchanged
     * for another one between frames needs el_frame_forget with `reuse`. */
    const el_layer *under, *over;
    const el_workers *workers; /* NULL: the caller's core draws alone. Else memory_bytes is EL_WORKERS_BYTES more */
} el_config;

/* A core beside the caller's. */
typedef struct el_worker {
    el_painter painter;
    el_stats stats; /* what it did in this pass */
} el_worker;

/* What is known of the frame before (quiet.h). */
typedef struct el_quiet {
    uint8_t known;          /* EL_REUSE_ bits that the frame before allows */
    uint8_t takers;         /* a bit for each sink that takes the bands of this frame, ... */
    uint8_t band_takers;    /* ... and of the band that is handed over */
    uint8_t looks;          /* this pass only looks at what is submitted */
    uint8_t refused;        /* a draw of this frame had an error */
    uint8_t group_log2;     /* bands that share a bit in the next two */
    uint16_t background;    /* of the frame before */
    uint32_t drawn;         /* groups of bands with triangles, of this frame ... */
    uint32_t was_drawn;     /* ... and of the one before */
    uint32_t submitted;     /* a hash, of this frame ... */
    uint32_t was_submitted; /* ... and of the one before */
} el_quiet;

/* Owned by the caller; its members are the renderer's. Small ones come first: Thumb code reaches them at once there. */
typedef struct el_renderer {
    uint8_t in_frame;
    uint8_t workers; /* 1, or config.workers' count */
#if EL_WITH_DEBUG_VIEWS
    uint8_t pass_draws; /* draws before this pass, modulo 256 */
#endif
    uint16_t band_count; /* of this frame */
    uint16_t pass_begin; /* bands of this pass */
    uint16_t pass_end;
    uint16_t pass_bands;  /* what the next pass tries for */
    uint32_t list_bytes;  /* all that lies between the bins and the depth bands */
    uint32_t depth_bytes; /* of all depth bands */
    uint32_t fixed_bytes; /* bands and bins */
    el_config config;     /* its width that of the bands while they are drawn, in stripes if there are any */
    el_list list;
    el_stats stats;
    el_painter painter;  /* of the caller's core */
    el_worker *others;   /* of the others, in the arena */
    uint16_t *part_bins; /* their bins for parts of a draw call, ... */
    uint32_t bin_stride; /* ... so far apart */
#if EL_WITH_REUSE
    el_quiet quiet;
#endif
    el_view view;
} el_renderer;

/* EL_ERROR_ARGUMENT, EL_ERROR_SIZE, EL_ERROR_MEMORY. EL_ERROR_SIZE also for a view, a shading_off or a reuse that does not
 * exist or that base/options.h leaves out, and for what does not go with `interlaced`; EL_ERROR_ARGUMENT where that has a
 * sink that takes no gaps. */
el_status el_init(el_renderer *renderer, const el_config *config);

/* Starts a frame. EL_ERROR_CAMERA or EL_ERROR_RANGE for a camera that cannot be used; no frame has begun then. */
el_status el_frame_begin(el_renderer *renderer, const el_camera *camera);

/* Draws a mesh. `mesh`, `material` and all that they point to must stay until the frame is done; `pose` may change.
 * EL_ERROR_MATERIAL: textured without texture or texture coordinates, or with a texture or an image of another size,
 * format or chain than geometry/mesh.h has; a light without normals; EL_MATERIAL_BLEND_DEPTH of what is blended with
 * el_config.depth_prepass; fog that was not made, without depth or with an orthographic camera; EL_MATERIAL_WIRES of
 * what is not flat, is blended or in fog, or with several samples or stripes; EL_SHADE_OVERDRAW with several samples; or
 * what base/options.h leaves out. EL_ERROR_RANGE: the pose or the mesh leaves the world, or the mesh is too large for so
 * narrow a view. EL_ERROR_SIZE: too many triangles. On an error nothing of the mesh is drawn.
 * The mesh's indices and its bounding sphere are trusted; el_elm_open checks them, the converter makes them. */
el_status el_draw(el_renderer *renderer, const el_mesh *mesh, const el_pose *pose, const el_material *material);

/* Draws and hands over the bands of this pass. Returns 1 when the frame needs another pass: submit everything again, in
 * the same order. Returns 0 when the frame is done, and a negative el_status outside a frame. */
int el_frame_next(el_renderer *renderer);

/* Says that what the pointers of meshes or materials name has changed: the next frame is drawn, whatever el_config.reuse
 * is. Between frames. */
void el_frame_forget(el_renderer *renderer);

/* The counters of the frame under way, or of the last one. */
const el_stats *el_frame_stats(const el_renderer *renderer);

#ifdef __cplusplus
}
#endif

#endif
