/* What several samples per pixel take of a band's memory: all that the renderer's users have to know of samples.h. */
#ifndef EL_RASTER_SAMPLE_MEMORY_H
#define EL_RASTER_SAMPLE_MEMORY_H

enum { EL_MAX_SAMPLES = 8 };

/* Words of a row's mixed bits, a bit per pixel; those of a band's rows lie behind each other without a gap. */
#define EL_MIXED_WORDS(width) (((width) + 31U) / 32U)

#endif
