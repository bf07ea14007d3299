/* The reader of .elm on any bytes, and the renderer on what it accepts: an accepted mesh must be safe to draw. A CRC is
 * what random bytes never have, so the first byte says whether version, size
 * and CRC are made right before. */
#include "base/crc32.h"
#include "picture.h"

enum { SIZE_AT = 8, CRC_AT = 12, CRC_FROM = 16, HEADER = 32 };

static void put_u32(uint8_t *to, uint32_t value)
{
    for (unsigned i = 0; i < 4; i++) {
        to[i] = (uint8_t)(value >> (8 * i));
    }
}

static void draw(const el_mesh *mesh, const el_elm_surface *surface, uint8_t how)
{
    const el_texture *const texture = &surface->levels[0];
    const bool has_texture = texture->texels != NULL || texture->image != NULL;
    static picture p;
    p.width = 48;
    p.height = 32;
    const el_sink sink = picture_sink(&p);
    const way w = way_of(p.width, p.height, how, (uint16_t)(how * 64));
    uint8_t *const memory = malloc(w.memory_bytes);
    FUZZ_EXPECT(memory != NULL);
    const el_config config = {.width = p.width,
                              .height = p.height,
                              .band_lines = w.band_lines,
                              .memory = memory,
                              .memory_bytes = w.memory_bytes,
                              .sinks = {&sink}};
    el_camera camera = {.fov_y = EL_DEGREES(60, 1), .near_q16 = EL_UNIT_Q16 / 16, .far_q16 = 1024 * EL_UNIT_Q16};
    const int32_t eye[3] = {0, 0, (how & 15) * EL_UNIT_Q16};
    const int32_t target[3] = {0, EL_UNIT_Q16 / 8, -EL_UNIT_Q16};
    const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    FUZZ_EXPECT(el_camera_look_at(&camera, eye, target, up) == EL_OK);
    const el_light light = {.direction_q30 = {0, EL_UNIT_Q30, 0}, .ambient = 90, .diffuse = 200};
    const el_material material = {
        .shading = (uint8_t)(has_texture ? EL_SHADE_TEXTURED_GOURAUD : how % 2),
        .flags = EL_MATERIAL_TWO_SIDED,
        .alpha = surface->alpha,
        .texture = texture,
        .light = mesh->normals != NULL ? &light : NULL,
    };
    const el_pose pose = el_pose_identity();
    el_renderer renderer;
    FUZZ_EXPECT(el_init(&renderer, &config) == EL_OK);
    FUZZ_EXPECT(el_frame_begin(&renderer, &camera) == EL_OK);
    do {
        const el_status status = el_draw(&renderer, mesh, &pose, &material);
        FUZZ_EXPECT(status == EL_OK || status == EL_ERROR_RANGE);
    } while (el_frame_next(&renderer) > 0);
    free(memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    if (count < 1) {
        return 0;
    }
    const uint8_t how = bytes[0];
    const size_t size = count - 1;
    uint8_t *const file = malloc(size > 0 ? size : 1);
    FUZZ_EXPECT(file != NULL);
    memcpy(file, bytes + 1, size);
    if ((how & 128) != 0 && size >= HEADER) {
        memcpy(file, "ELM\x1a\1\0", 6);
        file[4] = (how & 64) != 0 ? 2 : 1;
        put_u32(file + SIZE_AT, (uint32_t)size);
        put_u32(file + CRC_AT, el_crc32(0, file + CRC_FROM, size - CRC_FROM));
    }
    el_mesh mesh;
    el_elm_surface surface;
    const el_elm_status status = el_elm_open_surface(file, size, &mesh, &surface);
    FUZZ_EXPECT(status <= 0 && el_elm_message(status)[0] != '\0');
    if (status == EL_ELM_OK) {
        draw(&mesh, &surface, how & 127);
    }
    free(file);
    return 0;
}
