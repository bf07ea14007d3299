/* An INPUT may arrive while a frame is drawn, so a frame takes all that it needs of the player before it begins. */
#include "player.h"

static bool is_within(int32_t value, int32_t least, int32_t most)
{
    return value >= least && value <= most;
}

/* What the host sets of scenes and frames. */
static void direct(el_player *p, uint8_t control, int32_t value)
{
    if (control == EL_CONTROL_SCENE && value >= 0 && (uint32_t)value < el_scene_count()) {
        p->scene = el_scene_at((size_t)value);
        p->frame = 0;
    } else if (control == EL_CONTROL_FRAME && value >= 0) {
        p->frame = (uint32_t)value;
    } else if (control == EL_CONTROL_PAUSE && is_within(value, 0, 1)) {
        p->paused = value == 1;
    } else if (control == EL_CONTROL_STEP && p->paused && value > 0) {
        p->frame += (uint32_t)value;
    }
}

static void move(el_orbit *orbit, uint8_t control, int32_t value)
{
    if (control == EL_CONTROL_YAW) {
        orbit->yaw = (uint16_t)((uint32_t)value & 0xFFFFU);
    } else if (control == EL_CONTROL_PITCH && is_within(value, -EL_ORBIT_QUARTER_TURN, EL_ORBIT_QUARTER_TURN)) {
        orbit->pitch = (int16_t)value;
    } else if (control == EL_CONTROL_ZOOM && is_within(value, -EL_ORBIT_MAX_ZOOM_Q8, EL_ORBIT_MAX_ZOOM_Q8)) {
        orbit->zoom_q8 = (int16_t)value;
    } else if ((control == EL_CONTROL_PAN_X || control == EL_CONTROL_PAN_Y) &&
               is_within(value, -EL_ORBIT_MAX_PAN_Q8, EL_ORBIT_MAX_PAN_Q8)) {
        orbit->pan_q8[control == EL_CONTROL_PAN_Y] = (int16_t)value;
    }
}

static void look(el_player *p, uint8_t control, int32_t value)
{
    /* SHADING's values: as the scene is made; flat; no textures; no vertex colours. */
    static const uint8_t off[] = {0, EL_SHADE_TEXTURED | EL_SHADE_GOURAUD, EL_SHADE_TEXTURED, EL_SHADE_GOURAUD};

    if (control == EL_CONTROL_TEXTURE_ERROR && is_within(value, 0, 5)) {
        p->texture_error = (uint8_t)value;
    } else if (control == EL_CONTROL_SHADING && is_within(value, 0, (int32_t)sizeof off - 1)) {
        p->shading_off = off[value];
    } else if (control == EL_CONTROL_VIEW && is_within(value, 0, EL_DEBUG_VIEWS - 1)) {
        p->view = (uint8_t)value;
    }
}

void el_player_input(void *player, uint8_t control, int32_t value)
{
    el_player *const p = player;

    if (control > 31 || (EL_PLAYER_CONTROLS >> control & 1U) == 0) {
        return;
    }
    direct(p, control, value);
    move(&p->orbit, control, value);
    look(p, control, value);
}

static void place_camera(const el_player *player, uint32_t frame, el_camera *camera)
{
    const el_scene *const scene = player->scene;
    scene->place_camera(frame, camera);
    const uint32_t focus_q16 = scene->focus_q16 != NULL ? scene->focus_q16(frame) : 0;
    el_orbit_apply(&player->orbit, focus_q16 != 0 ? focus_q16 : el_orbit_focus_q16(camera), camera);
}

el_status el_player_play(el_player *player, el_renderer *renderer)
{
    const el_scene *scene = player->scene;
    const uint32_t frame = player->frame;
    el_config *const config = &renderer->config;
    el_camera camera = {0};

    player->frame = player->paused ? frame : frame + 1;
    if (player->own_texture_error == 0) {
        player->own_texture_error = config->uv_error_log2;
    }
    config->uv_error_log2 = player->texture_error != 0 ? player->texture_error : player->own_texture_error;
    config->shading_off = player->shading_off;
    config->view = player->view;
    config->background = scene->background;
    place_camera(player, frame, &camera);
    return el_scene_show(scene, frame, &camera, renderer);
}
