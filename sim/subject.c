#include "subject.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "machine.h"
#include "options.h"
#include "report.h"

/* From the upper left and the viewer's side; (-2, 3, 2) / sqrt(17). */
static const el_light light = {.direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 70, .diffuse = 185};

static const double max_position = 16384;

static int32_t q16(double value)
{
    return (int32_t)lround(value * 65536.0);
}

static bool choose_shading(el_subject_mesh *subject, const char *name, const el_subject_options *options)
{
    static const char *const names[] = {"flat", "gouraud", "textured"};
    el_material *const material = &subject->material;
    const el_texture *const texture = &subject->surface.levels[0];
#if EL_WITH_MIXED
    const bool has_texture = texture->texels != NULL || texture->image != NULL;
    material->alpha = subject->surface.alpha;
#else
    const bool has_texture = texture->texels != NULL;
#endif
    const bool is_faceted = subject->mesh.triangle_colours != NULL && subject->mesh.colours == NULL;
    const bool is_lit = options->shading != NULL && strcmp(options->shading, "lit") == 0;
    const el_shading texels = subject->mesh.colours != NULL || is_lit ? EL_SHADE_TEXTURED_GOURAUD : EL_SHADE_TEXTURED;
    material->shading = (uint8_t)(has_texture ? texels : is_faceted ? EL_SHADE_FLAT : EL_SHADE_GOURAUD);
    if (options->shading != NULL && !is_lit) {
        unsigned i = 0;
        while (i < 3 && strcmp(options->shading, names[i]) != 0) {
            i++;
        }
        if (i == 3) {
            el_report("--shading takes flat, gouraud, textured or lit, not '%s'", options->shading);
            return false;
        }
        material->shading = (uint8_t)i;
    }
    if (material->shading == EL_SHADE_TEXTURED && !has_texture) {
        el_report("%s has no texture: convert it with one, or use --shading flat or gouraud", name);
        return false;
    }
    for (unsigned i = 0; i < 3; i++) {
        material->colour[i] = has_texture ? 255 : 200; /* of what has none of its own; texels are multiplied by it */
    }
    material->flags = (uint8_t)(EL_MATERIAL_FLAT_MEAN | subject->surface.flags);
    material->texture = texture;
    material->light =
        subject->mesh.normals != NULL && (is_lit || !el_has_texture((el_shading)material->shading)) ? &light : NULL;
    return true;
}

typedef struct sphere {
    double centre[3];
    double radius;
} sphere;

static sphere sphere_of(const el_mesh *mesh)
{
    const double unit = ldexp(1, mesh->scale_log2);
    sphere result = {.radius = (mesh->radius > 0 ? mesh->radius : 1) * unit};
    for (int i = 0; i < 3; i++) {
        result.centre[i] = mesh->centre[i] * unit;
    }
    return result;
}

/* Around the spheres of all meshes: that of the only one, or else around the middle of their box. */
static sphere sphere_around(const el_subject *subject)
{
    sphere result = sphere_of(&subject->meshes[0].mesh);
    if (subject->mesh_count == 1) {
        return result;
    }
    for (int i = 0; i < 3; i++) {
        double low = INFINITY;
        double high = -INFINITY;
        for (unsigned k = 0; k < subject->mesh_count; k++) {
            const sphere one = sphere_of(&subject->meshes[k].mesh);
            low = fmin(low, one.centre[i] - one.radius);
            high = fmax(high, one.centre[i] + one.radius);
        }
        result.centre[i] = (low + high) / 2;
    }
    result.radius = 0;
    for (unsigned k = 0; k < subject->mesh_count; k++) {
        const sphere one = sphere_of(&subject->meshes[k].mesh);
        double squared = 0;
        for (int i = 0; i < 3; i++) {
            squared += (one.centre[i] - result.centre[i]) * (one.centre[i] - result.centre[i]);
        }
        result.radius = fmax(result.radius, sqrt(squared) + one.radius);
    }
    return result;
}

/* By default the camera stands where the bounding sphere just fits the picture's narrower side, half to the right and
 * above. */
static bool place_camera(el_subject *subject, const el_subject_options *options, double aspect)
{
    const sphere all = sphere_around(subject);
    const double radius = all.radius;
    double target[3];
    double eye[3];
    double fov = 45;
    for (int i = 0; i < 3; i++) {
        target[i] = all.centre[i];
    }
    if (options->fov != NULL && !el_option_number("--fov", options->fov, 1, 179, &fov)) {
        return false;
    }
    if (options->look_at != NULL && !el_option_vector("--look-at", options->look_at, max_position, target)) {
        return false;
    }
    static const double direction[3] = {0.48, 0.36, 0.8};
    const double half = tan(fov * (M_PI / 360)) * fmin(aspect, 1);
    const double fitting = radius / sin(atan(half)) * 1.02;
    double distance = 0;
    for (int i = 0; i < 3; i++) {
        eye[i] = target[i] + direction[i] * fitting;
    }
    if (options->eye != NULL && !el_option_vector("--eye", options->eye, max_position, eye)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        const double difference = all.centre[i] - eye[i];
        distance += difference * difference;
    }
    distance = sqrt(distance);
    double far = distance + radius * 1.1;
    double near = fmax(fmin(fmax(distance - radius * 1.1, far / 1000), far * 8 / 9), 1.0 / 4096);
    if ((options->near != NULL && !el_option_number("--near", options->near, 1.0 / 4096, max_position, &near)) ||
        (options->far != NULL && !el_option_number("--far", options->far, 1.0 / 4096, max_position, &far))) {
        return false;
    }
    if (far < near * 9 / 8) {
        el_report("--far %g must be at least 9/8 of --near %g", far, near);
        return false;
    }

    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    el_camera *const camera = &subject->camera;
    int32_t eye_q16[3];
    int32_t target_q16[3];
    for (int i = 0; i < 3; i++) {
        if (fabs(eye[i]) > max_position || far > max_position) {
            el_report("%s is too large for the default camera: give --eye and --far", options->meshes[0]);
            return false;
        }
        eye_q16[i] = q16(eye[i]);
        target_q16[i] = q16(target[i]);
    }
    camera->projection = EL_PERSPECTIVE;
    camera->fov_y = (el_angle)llround(fov / 360 * 4294967296.0);
    camera->near_q16 = (uint32_t)q16(near);
    camera->far_q16 = (uint32_t)q16(far);
    const el_status status = el_camera_look_at(camera, eye_q16, target_q16, up_q16);
    if (status != EL_OK) {
        el_report("--eye must differ from --look-at, and not stand straight above or below it");
    }
    return status == EL_OK;
}

static bool open_mesh(el_subject *subject, const char *name, const el_subject_options *options)
{
    el_subject_mesh *const one = &subject->meshes[subject->mesh_count];
    size_t size;
    one->file = el_file_read(name, &size);
    if (one->file == NULL) {
        return false;
    }
    subject->mesh_count++;
    const el_elm_status status = el_elm_open_surface(one->file, size, &one->mesh, &one->surface);
    if (status != EL_ELM_OK) {
        el_report("%s: %s", name, el_elm_message(status));
        return false;
    }
    return choose_shading(one, name, options);
}

static bool open_meshes(el_subject *subject, const el_subject_options *options, double aspect)
{
    for (unsigned i = 0; i < options->mesh_count; i++) {
        if (!open_mesh(subject, options->meshes[i], options)) {
            return false;
        }
    }
    return place_camera(subject, options, aspect);
}

bool el_subject_open(el_subject *subject, const el_subject_options *options, double aspect)
{
    *subject = (el_subject){0};
    if (options->mesh_count > 0) {
        if (options->scene != NULL) {
            el_report("--scene and --mesh exclude each other");
            return false;
        }
        return open_meshes(subject, options, aspect);
    }
    if (options->eye != NULL || options->look_at != NULL || options->fov != NULL || options->near != NULL ||
        options->far != NULL) {
        el_report("--eye, --look-at, --fov, --near and --far go with --mesh; a scene has its own camera");
        return false;
    }
    const char *const name = options->scene != NULL ? options->scene : "demo";
    subject->scene = el_scene_find(name);
    if (subject->scene == NULL) {
        el_report("there is no scene '%s'; `edgeline-sim list` names them", name);
    }
    return subject->scene != NULL;
}

void el_subject_close(el_subject *subject)
{
    for (unsigned i = 0; i < subject->mesh_count; i++) {
        free(subject->meshes[i].file);
    }
    *subject = (el_subject){0};
}

uint16_t el_subject_background(const el_subject *subject)
{
    return subject->scene != NULL ? subject->scene->background : 0;
}

el_status el_subject_play(const el_subject *subject, uint32_t frame, el_renderer *renderer)
{
    if (subject->scene != NULL) {
        return el_scene_play(subject->scene, frame, renderer);
    }
    el_status status = el_frame_begin(renderer, &subject->camera);
    if (status != EL_OK) {
        return status;
    }
    const el_pose pose = el_pose_identity();
    int more;
    do {
        for (unsigned i = 0; i < subject->mesh_count && status == EL_OK; i++) {
            status = el_draw(renderer, &subject->meshes[i].mesh, &pose, &subject->meshes[i].material);
        }
        more = el_frame_next(renderer);
    } while (more > 0);
    return more < 0 ? (el_status)more : status;
}
