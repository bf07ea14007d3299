/* The standard scenes alone, for builds that leave something out (bench_tool/features.py): a shading that is left out
 * has no picture. Counters are 0 without EL_WITH_STATS.
 *
 *     SCENE crc CRC status STATUS rows ROWS pixels PIXELS
 */
#include "bench/bench_scenes.h"
#include "frame.h"
#include "platform.h"

enum { BAND_LINES = 8, ARENA = 130 * 1024 };

static _Alignas(8) uint8_t arena[ARENA];

int bench_main(void)
{
    static el_renderer renderer;
    const bench_setting setting = {.band_lines = BAND_LINES, .arena = arena, .arena_bytes = sizeof arena};
    bench_empty();
    for (size_t i = 0; i < el_bench_scene_count; i++) {
        bench_picture picture;
        const el_status status = bench_frame(&el_bench_scenes[i], 0, &setting, &renderer, &picture);
        bench_print(el_bench_scenes[i].name);
        bench_print(" crc ");
        bench_print_hex(picture.crc);
        bench_print_item(" status ", (uint64_t)-status);
        bench_print_item(" rows ", el_frame_stats(&renderer)->rows);
        bench_print_item(" pixels ", el_frame_stats(&renderer)->pixels);
        bench_print("\n");
    }
    return 0;
}
