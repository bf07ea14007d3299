#include "methods/cases.h"

#include "base/angle.h"

const char *const el_triangle_kind_names[EL_TRIANGLE_KINDS] = {
    [EL_TRIANGLES_SMALL] = "small",   [EL_TRIANGLES_MEDIUM] = "medium", [EL_TRIANGLES_LARGE] = "large",
    [EL_TRIANGLES_SLIVER] = "sliver", [EL_TRIANGLES_FAN] = "fan",       [EL_TRIANGLES_CENTRED] = "centred",
    [EL_TRIANGLES_AXIS] = "axis",
};

const char *const el_polygon_kind_names[EL_POLYGON_KINDS] = {
    [EL_POLYGONS_CONVEX] = "convex", [EL_POLYGONS_STAR] = "star",         [EL_POLYGONS_CONCAVE] = "concave",
    [EL_POLYGONS_HOLE] = "hole",     [EL_POLYGONS_CROSSING] = "crossing",
};

/* --- Random numbers: Marsaglia, "Xorshift RNGs", 2003 -------------------------------------------------------------- */

el_random el_random_of(uint32_t seed, uint32_t kind)
{
    el_random random = {((uint64_t)seed << 8 | kind) * 0x9E3779B97F4A7C15U + 1U};
    for (unsigned i = 0; i < 8; i++) { /* small seeds begin alike */
        el_random_between(&random, 0, 1);
    }
    return random;
}

int32_t el_random_between(el_random *random, int32_t least, int32_t most)
{
    random->state ^= random->state << 13;
    random->state ^= random->state >> 7;
    random->state ^= random->state << 17;
    return least + (int32_t)((random->state >> 16) % ((uint64_t)((int64_t)most - least) + 1));
}

/* --- Places ------------------------------------------------------------------------------------------------------- */

/* Anywhere in the picture but for `inset` pixels around it. */
static el_spot any_spot(el_random *random, int32_t inset)
{
    const int32_t x = el_random_between(random, inset * EL_SUBPIXELS, (EL_CASES_WIDTH - inset) * EL_SUBPIXELS);
    const int32_t y = el_random_between(random, inset * EL_SUBPIXELS, (EL_CASES_HEIGHT - inset) * EL_SUBPIXELS);
    return (el_spot){x, y};
}

/* The centre of the pixel that the coordinate lies in. */
static int32_t centred(int32_t coordinate)
{
    return coordinate - (coordinate & (EL_SUBPIXELS - 1)) + EL_SUBPIXELS / 2;
}

static el_spot centred_spot(el_spot spot)
{
    return (el_spot){centred(spot.x), centred(spot.y)};
}

/* A spot not further than `reach` pixels in x and in y. */
static el_spot any_spot_near(el_random *random, el_spot spot, int32_t reach)
{
    const int32_t dx = el_random_between(random, -reach * EL_SUBPIXELS, reach * EL_SUBPIXELS);
    const int32_t dy = el_random_between(random, -reach * EL_SUBPIXELS, reach * EL_SUBPIXELS);
    return (el_spot){spot.x + dx, spot.y + dy};
}

/* `part` of `parts` of a turn, and up to a third of a part more by chance: angles ascend, and neighbours are less than
 * half a turn apart when there are three parts or more. */
static el_angle angle_of(el_random *random, int32_t part, int32_t parts)
{
    const uint32_t width = UINT32_MAX / (uint32_t)parts;
    return (uint32_t)part * width + (uint32_t)el_random_between(random, 0, (int32_t)(width / 3));
}

/* radius in sub-pixels, at most 2^14 */
static el_spot on_circle(el_spot middle, int32_t radius, el_angle angle)
{
    const int64_t half = (int64_t)1 << 29;
    return (el_spot){
        middle.x + (int32_t)(((int64_t)el_cos_q30(angle) * radius + half) >> 30),
        middle.y + (int32_t)(((int64_t)el_sin_q30(angle) * radius + half) >> 30),
    };
}

/* --- Triangles ---------------------------------------------------------------------------------------------------- */

/* The third corner lies beside the line between the others. */
static void any_sliver(el_random *random, el_spot corners[3])
{
    corners[0] = any_spot(random, 4);
    corners[1] = any_spot(random, 4);
    const int32_t along = el_random_between(random, 0, 256);
    corners[2].x = corners[0].x + (corners[1].x - corners[0].x) * along / 256 + el_random_between(random, -3, 3);
    corners[2].y = corners[0].y + (corners[1].y - corners[0].y) * along / 256 + el_random_between(random, -3, 3);
}

static void any_axis_aligned(el_random *random, el_spot corners[3])
{
    corners[0] = any_spot(random, 4);
    corners[1] = any_spot(random, 4);
    for (unsigned i = 0; i < 2; i++) {
        corners[i].x = el_random_between(random, 0, 1) ? centred(corners[i].x) : corners[i].x;
        corners[i].y = el_random_between(random, 0, 1) ? centred(corners[i].y) : corners[i].y;
    }
    corners[2] = (el_spot){corners[1].x, corners[0].y};
}

void el_any_triangle(el_random *random, el_triangle_kind kind, el_spot corners[3])
{
    if (kind == EL_TRIANGLES_SLIVER) {
        any_sliver(random, corners);
        return;
    }
    if (kind == EL_TRIANGLES_AXIS) {
        any_axis_aligned(random, corners);
        return;
    }
    const el_spot middle = any_spot(random, 26);
    for (unsigned i = 0; i < 3; i++) {
        switch (kind) {
        case EL_TRIANGLES_SMALL:
            corners[i] = any_spot_near(random, middle, 6);
            break;
        case EL_TRIANGLES_MEDIUM:
            corners[i] = any_spot_near(random, middle, 24);
            break;
        case EL_TRIANGLES_CENTRED:
            corners[i] = centred_spot(any_spot_near(random, middle, 12));
            break;
        default:
            corners[i] = any_spot(random, 2);
        }
    }
}

void el_any_fan(el_random *random, uint32_t index, el_fan *fan)
{
    const int32_t parts = el_random_between(random, EL_FAN_LEAST, EL_FAN_MOST);
    const bool on_centres = (index & 1U) != 0;
    const el_spot place = any_spot(random, 40);
    const el_spot hub = on_centres ? centred_spot(place) : place;
    el_spot rim[EL_FAN_MOST];
    for (int32_t i = 0; i < parts; i++) {
        const int32_t radius = el_random_between(random, 12 * EL_SUBPIXELS, 38 * EL_SUBPIXELS);
        const el_spot spot = on_circle(hub, radius, angle_of(random, i, parts));
        rim[i] = on_centres ? centred_spot(spot) : spot;
    }
    fan->count = (size_t)parts;
    for (size_t i = 0; i < fan->count; i++) {
        fan->triangles[i][0] = hub;
        fan->triangles[i][1] = rim[i];
        fan->triangles[i][2] = rim[(i + 1) % fan->count];
    }
}

/* --- Polygons ----------------------------------------------------------------------------------------------------- */

enum { MOST_CORNERS = 24 };

/* Adds an outline, on centres where the polygon's are, turned the other way around if wanted. */
static void add_outline(el_polygon *polygon, el_spot *spots, size_t count, bool on_centres, bool reversed)
{
    for (size_t i = 0; on_centres && i < count; i++) {
        spots[i] = centred_spot(spots[i]);
    }
    for (size_t i = 0; reversed && i < count / 2; i++) {
        const el_spot other = spots[i];
        spots[i] = spots[count - 1 - i];
        spots[count - 1 - i] = other;
    }
    el_polygon_add(polygon, spots, count);
}

/* Corners on a circle whose radius is the one or the other in turn. */
static size_t ring(el_random *random, el_spot middle, int32_t corners, const int32_t radius_px[2],
                   el_spot spots[MOST_CORNERS])
{
    for (int32_t i = 0; i < corners; i++) {
        spots[i] = on_circle(middle, radius_px[i & 1] * EL_SUBPIXELS, angle_of(random, i, corners));
    }
    return (size_t)corners;
}

/* A back along the upper side, and teeth that hang from it. */
static size_t comb(el_random *random, el_spot spots[MOST_CORNERS])
{
    const int32_t teeth = el_random_between(random, 2, (MOST_CORNERS - 2) / 2);
    const int32_t left = el_random_between(random, 4, 30) * EL_SUBPIXELS;
    const int32_t top = el_random_between(random, 4 * EL_SUBPIXELS, 30 * EL_SUBPIXELS);
    const int32_t pitch = (EL_CASES_WIDTH * EL_SUBPIXELS - left - 4 * EL_SUBPIXELS) / (2 * teeth);
    size_t count = 0;
    spots[count++] = (el_spot){left, top};
    spots[count++] = (el_spot){left + (2 * teeth - 1) * pitch, top};
    for (int32_t i = 2 * teeth - 1; i >= 0; i--) {
        const bool is_tip = (i & 1) != 0;
        const int32_t y = top + el_random_between(random, is_tip ? 40 * EL_SUBPIXELS : 8 * EL_SUBPIXELS,
                                                  is_tip ? 84 * EL_SUBPIXELS : 32 * EL_SUBPIXELS);
        spots[count++] = (el_spot){left + i * pitch, y};
    }
    return count;
}

static void add_holes(el_random *random, el_spot middle, bool on_centres, el_polygon *polygon)
{
    el_spot spots[MOST_CORNERS];
    const int32_t holes = el_random_between(random, 1, 2);
    for (int32_t i = 0; i < holes; i++) {
        const int32_t aside = holes == 1 ? 0 : (2 * i - 1) * 16 * EL_SUBPIXELS;
        const int32_t corners = el_random_between(random, 3, 8);
        const int32_t radius = el_random_between(random, 6, 14);
        const size_t count =
            ring(random, (el_spot){middle.x + aside, middle.y}, corners, (const int32_t[2]){radius, radius}, spots);
        add_outline(polygon, spots, count, on_centres, el_random_between(random, 0, 1) != 0);
    }
}

void el_any_polygon(el_random *random, el_polygon_kind kind, uint32_t index, el_polygon *polygon)
{
    const bool on_centres = (index & 1U) != 0;
    const el_spot middle = any_spot(random, 54);
    el_spot spots[MOST_CORNERS];
    size_t count = 0;
    polygon->edge_count = 0;
    switch (kind) {
    case EL_POLYGONS_CONVEX: {
        const int32_t radius = el_random_between(random, 8, 50);
        const int32_t corners = el_random_between(random, 3, 16);
        count = ring(random, middle, corners, (const int32_t[2]){radius, radius}, spots);
        break;
    }
    case EL_POLYGONS_STAR: {
        const int32_t tip = el_random_between(random, 30, 50);
        const int32_t notch = el_random_between(random, 8, 22);
        const int32_t corners = 2 * el_random_between(random, 3, 9);
        count = ring(random, middle, corners, (const int32_t[2]){tip, notch}, spots);
        break;
    }
    case EL_POLYGONS_CONCAVE:
        count = comb(random, spots);
        break;
    case EL_POLYGONS_HOLE:
        count = ring(random, middle, el_random_between(random, 8, 16), (const int32_t[2]){50, 50}, spots);
        break;
    default:
        count = (size_t)el_random_between(random, 4, 14);
        for (size_t i = 0; i < count; i++) {
            spots[i] = any_spot(random, 4);
        }
    }
    add_outline(polygon, spots, count, on_centres, el_random_between(random, 0, 1) != 0);
    if (kind == EL_POLYGONS_HOLE) {
        add_holes(random, middle, on_centres, polygon);
    }
}
