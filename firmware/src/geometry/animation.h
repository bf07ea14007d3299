/* Movement from keys: where something is, how it is turned and how large it is at some times, and between them.
 *
 * All of it is const data, usable from flash. A time is looked up by halving, so any time costs about the same, and frames may
 * come in any order. At a key the value is the key's, to the last bit. */
#ifndef EL_GEOMETRY_ANIMATION_H
#define EL_GEOMETRY_ANIMATION_H

#include <stdint.h>

#include "geometry/pose.h"
#include "geometry/quaternion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How values go from a key to the next. */
typedef enum el_between {
    EL_BETWEEN_STEP,   /* the earlier one's, until the next */
    EL_BETWEEN_LINEAR, /* at constant speed; rotations by el_quaternion_slerp */
    EL_BETWEEN_SMOOTH /* cubic, without a jump in speed at keys (Catmull and Rom): the speed at a key is that from the key
                          before to the key after it, at the ends that to the only neighbour; so it may overshoot.
                          Rotations likewise, each of their four numbers, made a rotation again */
} el_between;

typedef struct el_key_times {
    const uint32_t *at_ms; /* [count] rising */
    uint16_t count;        /* 0: no track, nothing is set */
    uint8_t between;       /* el_between */
} el_key_times;

typedef struct el_position_track {
    el_key_times keys;
    const int32_t (*values_q16)[3]; /* [count] */
} el_position_track;

typedef struct el_rotation_track {
    el_key_times keys;
    const el_quaternion *values; /* [count], of length 1 */
} el_rotation_track;

typedef struct el_scale_track {
    el_key_times keys;
    const uint32_t *values_q16; /* [count], not 0 */
} el_scale_track;

typedef enum el_repeat {
    EL_REPEAT_ONCE,     /* stays at its end */
    EL_REPEAT_LOOP,     /* begins again: at the end it is at its beginning */
    EL_REPEAT_PING_PONG /* there and back */
} el_repeat;

typedef struct el_animation {
    el_position_track position;
    el_rotation_track rotation;
    el_scale_track scale;
    uint32_t length_ms; /* 0: always at its beginning */
    uint8_t repeat;     /* el_repeat */
} el_animation;

/* The time within the animation, 0 to length_ms, at `time_ms` from its start. */
uint32_t el_animation_time(const el_animation *animation, uint32_t time_ms);

/* Sets what the animation has tracks for, at `time_ms` from its start; the rest of the pose stays. Before the first key it
 * has the first one's values, behind the last one the last one's. */
void el_animation_pose(const el_animation *animation, uint32_t time_ms, el_pose *pose);

/* Single tracks, at their own time; count > 0. Between keys positions and scales are within 2 units, and 2^-28 of the ways to
 * the keys around them, of the exact polynomial. They saturate where they do not fit, a scale at 1. */
void el_position_at(const el_position_track *track, uint32_t time_ms, int32_t position_q16[3]);
el_quaternion el_rotation_at(const el_rotation_track *track, uint32_t time_ms);
uint32_t el_scale_at(const el_scale_track *track, uint32_t time_ms);

#ifdef __cplusplus
}
#endif

#endif
