#include "inputs.h"

#include <string.h>

#include "options.h"
#include "report.h"

const char *const el_view_names[] = {
    [EL_DEBUG_PICTURE] = "picture",     [EL_DEBUG_OVERDRAW] = "overdraw", [EL_DEBUG_DEPTH] = "depth",
    [EL_DEBUG_TRIANGLES] = "triangles", [EL_DEBUG_BANDS] = "bands",       [EL_DEBUG_REJECTED] = "rejected",
};
const char *const el_view_summaries[] = {
    [EL_DEBUG_PICTURE] = "what the display shows",
    [EL_DEBUG_OVERDRAW] = "how often each pixel was drawn",
    [EL_DEBUG_DEPTH] = "how far away each pixel is, the nearest ones white",
    [EL_DEBUG_TRIANGLES] = "each triangle in a colour of its own",
    [EL_DEBUG_BANDS] = "the picture, dark, with the work of each band as a bar over it",
    [EL_DEBUG_REJECTED] = "how often each pixel was found hidden",
};
const unsigned el_view_count = EL_DEBUG_VIEWS;
_Static_assert(sizeof el_view_names / sizeof el_view_names[0] >= EL_DEBUG_VIEWS, "a name for each view");
_Static_assert(sizeof el_view_summaries == sizeof el_view_names, "a summary for each name");

/* SHADING's values. */
static const char *const shading_names[] = {"as-made", "flat", "gouraud", "textured"};
enum { SHADINGS = sizeof shading_names / sizeof shading_names[0] };

/* The place of `text` in `names`, or -1. */
static int index_of(const char *text, const char *const *names, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (strcmp(text, names[i]) == 0) {
            return (int)i;
        }
    }
    return -1;
}

static bool give_view(const el_inputs *inputs, el_player *player)
{
    const int view = inputs->view != NULL ? index_of(inputs->view, el_view_names, el_view_count) : 0;
    if (view < 0) {
        el_report("there is no view '%s'; `edgeline-sim list views` names them", inputs->view);
        return false;
    }
    el_player_input(player, EL_CONTROL_VIEW, view);
    return true;
}

static bool give_shading(const el_inputs *inputs, el_player *player)
{
    const int shading = inputs->shading != NULL ? index_of(inputs->shading, shading_names, SHADINGS) : 0;
    if (shading < 0) {
        el_report("--shading takes flat, gouraud or textured, not '%s'", inputs->shading);
        return false;
    }
    el_player_input(player, EL_CONTROL_SHADING, shading);
    return true;
}

bool el_inputs_give(const el_inputs *inputs, el_player *player)
{
    const struct {
        const char *option, *text;
        uint8_t control;
        long least, most;
    } numbers[] = {
        {"--yaw", inputs->yaw, EL_CONTROL_YAW, -65536, 65536},
        {"--pitch", inputs->pitch, EL_CONTROL_PITCH, -EL_ORBIT_QUARTER_TURN, EL_ORBIT_QUARTER_TURN},
        {"--zoom", inputs->zoom, EL_CONTROL_ZOOM, -EL_ORBIT_MAX_ZOOM_Q8, EL_ORBIT_MAX_ZOOM_Q8},
        {"--pan-x", inputs->pan_x, EL_CONTROL_PAN_X, -EL_ORBIT_MAX_PAN_Q8, EL_ORBIT_MAX_PAN_Q8},
        {"--pan-y", inputs->pan_y, EL_CONTROL_PAN_Y, -EL_ORBIT_MAX_PAN_Q8, EL_ORBIT_MAX_PAN_Q8},
    };
    for (unsigned i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        long value;
        if (numbers[i].text == NULL) {
            continue;
        }
        if (!el_option_integer(numbers[i].option, numbers[i].text, numbers[i].least, numbers[i].most, &value)) {
            return false;
        }
        el_player_input(player, numbers[i].control, (int32_t)value);
    }
    return give_view(inputs, player) && give_shading(inputs, player);
}

bool el_inputs_move(const el_inputs *inputs)
{
    return inputs->yaw != NULL || inputs->pitch != NULL || inputs->zoom != NULL || inputs->pan_x != NULL ||
           inputs->pan_y != NULL;
}
