/* An INPUT may arrive while a frame is drawn, so a frame takes all that it needs of the player before it begins. */
#include "player.h"

#include "stream/session.h"

void el_player_input(void *player, uint8_t control, int32_t value)
{
    el_player *p = player;

    if (control == EL_CONTROL_SCENE && value >= 0 && (uint32_t)value < el_scene_count()) {
        p->scene = el_scene_at((size_t)value);
        p->frame = 0;
    } else if (control == EL_CONTROL_FRAME && value >= 0) {
        p->frame = (uint32_t)value;
    } else if (control == EL_CONTROL_PAUSE && (value == 0 || value == 1)) {
        p->paused = value == 1;
    }
}

el_status el_player_play(el_player *player, el_renderer *renderer)
{
    const el_scene *scene = player->scene;
    const uint32_t frame = player->frame;

    player->frame = player->paused ? frame : frame + 1;
    renderer->config.background = scene->background;
    return el_scene_play(scene, frame, renderer);
}
