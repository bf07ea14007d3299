/* How scenes write lengths and counts. */
#ifndef EL_APPS_SCENE_UNITS_H
#define EL_APPS_SCENE_UNITS_H

/* Tenths of a world unit, Q16.16: |n| < 2^31 / 2^16. */
#define TENTHS_Q16(n) ((n)*65536 / 10)

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#endif
