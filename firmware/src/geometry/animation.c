/* A time is a key and a part of the way to the next; values are polynomials in that part, in 64 bits with products of 95
 * (el_scale_i64), so that any values and times will do. */
#include "geometry/animation.h"

#include <stdbool.h>
#include <string.h>

#include "base/fixed.h"
#include "geometry/vector.h"

enum { PART_BITS = 31 };

/* Between keys `from` and `from` + 1, or at key `from` where `part` is 0. */
typedef struct place {
    uint32_t from;
    uint32_t part;                      /* of the way, times 2^PART_BITS; less than all of it */
    bool has_before, has_after;         /* keys on the outer sides of the two */
    uint32_t slope_before, slope_after; /* of the time between a key's neighbours, the part between the two keys */
} place;

static uint32_t part_of(uint32_t time_ms, uint32_t all_ms)
{
    return all_ms == 0 ? 0 : (uint32_t)(((uint64_t)time_ms << PART_BITS) / all_ms);
}

static place find(const el_key_times *keys, uint32_t time_ms)
{
    const uint32_t *const at = keys->at_ms;
    /* at[from] <= time < at[end], but before the first and behind the last. */
    uint32_t from = 0;
    uint32_t end = keys->count;
    while (end - from > 1) {
        const uint32_t middle = (from + end) / 2;
        if (at[middle] <= time_ms) {
            from = middle;
        } else {
            end = middle;
        }
    }
    place found = {.from = from};
    if (keys->between == EL_BETWEEN_STEP || from + 1U == keys->count || time_ms <= at[from]) {
        return found;
    }
    const uint32_t way = at[from + 1U] - at[from];
    found.part = part_of(time_ms - at[from], way);
    if (keys->between == EL_BETWEEN_SMOOTH) {
        found.has_before = from > 0;
        found.has_after = from + 2U < keys->count;
        found.slope_before = found.has_before ? part_of(way, at[from + 1U] - at[from - 1U]) : 0;
        found.slope_after = found.has_after ? part_of(way, at[from + 2U] - at[from]) : 0;
    }
    return found;
}

static int64_t times(int64_t value, uint32_t part)
{
    return el_scale_i64(value, part, PART_BITS);
}

/* values: at the key before, at both, at the key after. |values| <= 2^32. */
static int64_t mix(const place *p, bool smooth, const int64_t values[4])
{
    const int64_t way = values[2] - values[1];
    if (!smooth) {
        return values[1] + times(way, p->part);
    }
    /* Hermite's cubic from the two values and their speeds, which are ways for the time between the two: at most 2^33. */
    const int64_t leaving = p->has_before ? times(values[2] - values[0], p->slope_before) : way;
    const int64_t arriving = p->has_after ? times(values[3] - values[1], p->slope_after) : way;
    const int64_t cubic = leaving + arriving - 2 * way;
    const int64_t square = 3 * way - 2 * leaving - arriving;
    return values[1] + times(leaving + times(square + times(cubic, p->part), p->part), p->part);
}

void el_position_at(const el_position_track *track, uint32_t time_ms, int32_t position_q16[3])
{
    const place p = find(&track->keys, time_ms);
    const int32_t(*const key)[3] = &track->values_q16[p.from];
    if (p.part == 0) {
        memcpy(position_q16, *key, sizeof *key);
        return;
    }
    for (unsigned i = 0; i < 3; i++) {
        const int64_t values[4] = {p.has_before ? key[-1][i] : 0, key[0][i], key[1][i], p.has_after ? key[2][i] : 0};
        position_q16[i] = el_saturate_i32(mix(&p, track->keys.between == EL_BETWEEN_SMOOTH, values));
    }
}

uint32_t el_scale_at(const el_scale_track *track, uint32_t time_ms)
{
    const place p = find(&track->keys, time_ms);
    const uint32_t *const key = &track->values_q16[p.from];
    if (p.part == 0) {
        return *key;
    }
    const int64_t values[4] = {p.has_before ? key[-1] : 0, key[0], key[1], p.has_after ? key[2] : 0};
    const int64_t scale_q16 = mix(&p, track->keys.between == EL_BETWEEN_SMOOTH, values);
    return scale_q16 > UINT32_MAX ? UINT32_MAX : (scale_q16 < 1 ? 1U : (uint32_t)scale_q16);
}

/* `to`, or its negative, which is the same rotation: what is nearer to `from`. */
static el_quaternion near_one(const el_quaternion *from, const el_quaternion *to)
{
    el_quaternion near = *to;
    if (el_quaternion_is_far(from, to)) {
        for (unsigned i = 0; i < 4; i++) {
            near.q30[i] = el_saturate_i32(-(int64_t)to->q30[i]);
        }
    }
    return near;
}

el_quaternion el_rotation_at(const el_rotation_track *track, uint32_t time_ms)
{
    const place p = find(&track->keys, time_ms);
    const el_quaternion *const key = &track->values[p.from];
    if (p.part == 0) {
        return *key;
    }
    if (track->keys.between != EL_BETWEEN_SMOOTH) {
        return el_quaternion_slerp(&key[0], &key[1], p.part >> 1);
    }
    const el_quaternion next = near_one(&key[0], &key[1]);
    el_quaternion before = {{0}};
    el_quaternion after = {{0}};
    if (p.has_before) {
        before = near_one(&key[0], &key[-1]);
    }
    if (p.has_after) {
        after = near_one(&next, &key[2]);
    }
    el_quaternion mixed;
    for (unsigned i = 0; i < 4; i++) {
        const int64_t values[4] = {before.q30[i], key[0].q30[i], next.q30[i], after.q30[i]};
        mixed.q30[i] = el_saturate_i32(mix(&p, true, values));
    }
    return el_quaternion_normalise(&mixed);
}

uint32_t el_animation_time(const el_animation *animation, uint32_t time_ms)
{
    const uint32_t length = animation->length_ms;
    if (length == 0) {
        return 0;
    }
    if (animation->repeat == EL_REPEAT_LOOP) {
        return time_ms % length;
    }
    const uint32_t rounds = time_ms / length;
    if (animation->repeat == EL_REPEAT_PING_PONG) {
        const uint32_t rest = time_ms % length;
        return (rounds & 1U) != 0 ? length - rest : rest;
    }
    return rounds > 0 ? length : time_ms;
}

void el_animation_pose(const el_animation *animation, uint32_t time_ms, el_pose *pose)
{
    const uint32_t at_ms = el_animation_time(animation, time_ms);
    if (animation->position.keys.count > 0) {
        el_position_at(&animation->position, at_ms, pose->position_q16);
    }
    if (animation->rotation.keys.count > 0) {
        const el_quaternion q = el_rotation_at(&animation->rotation, at_ms);
        el_quaternion_to_rotation(&q, pose->rotation_q30);
    }
    if (animation->scale.keys.count > 0) {
        pose->scale_q16 = el_scale_at(&animation->scale, at_ms);
    }
}
