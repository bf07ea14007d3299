// The headers serve C++ as well, every one of them.
#include "edgeline.h"
#include "panel/ili9341.h"
#include "panel/ssd0323.h"
#include "panel/ssd1306.h"
#include "panel/st7735.h"
#include "panel/st7789.h"
#include "stream/sink.h"

extern "C" el_status turn(el_pose *pose);

el_status turn(el_pose *pose)
{
    el_pose_turn(pose, EL_AXIS_Y, 0);
    return EL_OK;
}
