"""What `edgeline budget` knows of the firmware. Made by host/make_budget.py; do not edit."""

# ruff: noqa: PLR0917 (parameters are those of the macros)

EL_BUDGET_STACK_BYTES = 2048
EL_BUDGET_WORKERS_STACK_BYTES = 512
EL_LIST_MAX_BYTES = 524280
EL_MAX_HEIGHT = 2040
EL_MAX_WIDTH = 2040
EL_MESH_MAX_VERTICES = 65535
EL_MIN_LIST_BYTES = 704
EL_RUN_BYTES = 160
EL_SPLIT_FULL_BYTES = 986
EL_SPLIT_MAX_GAP = 12
EL_STREAM_WIRE_BYTES = 860
EL_SUBPIXEL_BITS = 4
EL_TEXTURED_TRIANGLE_BYTES = 32
EL_TRIANGLE_BYTES = 24
EL_VERTEX_BYTES = 10

STRUCT_BYTES: dict[int, dict[str, int]] = {
    32: {"el_renderer": 428, "el_tft": 72, "el_oled": 44, "el_stream": 1480},
    64: {"el_renderer": 536, "el_tft": 112, "el_oled": 64, "el_stream": 1576},
}
"""By the bits of a pointer: 32 on microcontrollers, 64 in the simulator."""

FRAMES_SOURCE = "tests/bench/run --record-scenes, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

FRAMES: dict[str, tuple[str, dict[str, int]]] = {
    "S1": (
        "sphere of 1,024 triangles, Gouraud, depth",
        {
            "cortex-m0plus": 1585072,
            "cortex-m3": 899943,
            "cortex-m4f": 873994,
            "cortex-m7": 879431,
            "cortex-m33": 884446,
            "rv32imc": 1309261,
        },
    ),
    "S2": (
        "room of 12 triangles, textured, full screen, depth",
        {
            "cortex-m0plus": 4567473,
            "cortex-m3": 2298341,
            "cortex-m4f": 2303171,
            "cortex-m7": 2299213,
            "cortex-m33": 2314730,
            "rv32imc": 3440296,
        },
    ),
    "S2-no-depth": (
        "S2 without depth",
        {
            "cortex-m0plus": 3970109,
            "cortex-m3": 1825713,
            "cortex-m4f": 1821795,
            "cortex-m7": 1825490,
            "cortex-m33": 1831361,
            "rv32imc": 2771202,
        },
    ),
    "S3": (
        "4,000 small triangles, flat, depth",
        {
            "cortex-m0plus": 7884056,
            "cortex-m3": 4039255,
            "cortex-m4f": 3994087,
            "cortex-m7": 4072572,
            "cortex-m33": 3989791,
            "rv32imc": 4959866,
        },
    ),
    "S4": (
        "4,000 triangles of which 403 are on the screen, flat, depth",
        {
            "cortex-m0plus": 1584069,
            "cortex-m3": 833486,
            "cortex-m4f": 819427,
            "cortex-m7": 826108,
            "cortex-m33": 830597,
            "rv32imc": 1217285,
        },
    ),
    "teapot": (
        "Newell's teapot, lit, Gouraud-shaded",
        {
            "cortex-m0plus": 3593289,
            "cortex-m3": 1964872,
            "cortex-m4f": 1914457,
            "cortex-m7": 1928480,
            "cortex-m33": 1942606,
            "rv32imc": 2563509,
        },
    ),
    "room": (
        "two textured rooms to walk through",
        {
            "cortex-m0plus": 12738729,
            "cortex-m3": 6225559,
            "cortex-m4f": 6215087,
            "cortex-m7": 6163876,
            "cortex-m33": 6256291,
            "rv32imc": 8560523,
        },
    ),
    "solid": (
        "a truncated icosahedron, one colour per face",
        {
            "cortex-m0plus": 905007,
            "cortex-m3": 540125,
            "cortex-m4f": 538437,
            "cortex-m7": 539870,
            "cortex-m33": 538013,
            "rv32imc": 925113,
        },
    ),
    "field": (
        "an island of 2,592 small flat triangles",
        {
            "cortex-m0plus": 5898416,
            "cortex-m3": 3084679,
            "cortex-m4f": 3034876,
            "cortex-m7": 3074460,
            "cortex-m33": 3038916,
            "rv32imc": 3697174,
        },
    ),
    "S1-4x": (
        "S1 with 4 samples per pixel",
        {
            "cortex-m0plus": 3215449,
            "cortex-m3": 1936252,
            "cortex-m4f": 1914349,
            "cortex-m7": 1929149,
            "cortex-m33": 1918481,
            "rv32imc": 2648939,
        },
    ),
    "S3-4x": (
        "S3 with 4 samples per pixel",
        {
            "cortex-m0plus": 31473587,
            "cortex-m3": 17881786,
            "cortex-m4f": 17865037,
            "cortex-m7": 18062687,
            "cortex-m33": 17831428,
            "rv32imc": 22772501,
        },
    ),
    "teapot-4x": (
        "teapot with 4 samples per pixel",
        {
            "cortex-m0plus": 7664965,
            "cortex-m3": 4547111,
            "cortex-m4f": 4513228,
            "cortex-m7": 4547601,
            "cortex-m33": 4523699,
            "rv32imc": 5809405,
        },
    ),
    "room-4x": (
        "room with 4 samples per pixel",
        {
            "cortex-m0plus": 46305820,
            "cortex-m3": 21182114,
            "cortex-m4f": 21173539,
            "cortex-m7": 20961855,
            "cortex-m33": 21255990,
            "rv32imc": 24773499,
        },
    ),
    "S1-8x": (
        "S1 with 8 samples per pixel",
        {
            "cortex-m0plus": 4380138,
            "cortex-m3": 2726976,
            "cortex-m4f": 2683255,
            "cortex-m7": 2694213,
            "cortex-m33": 2724095,
            "rv32imc": 3504477,
        },
    ),
}
"""Of scenes at 320 x 240: what they are, and instructions of their first frame by core."""

LAWS_SOURCE = "tests/bench/run --record-growth, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

LAWS: dict[str, dict[str, tuple[float, float, float, float]]] = {
    "flat": {"cortex-m0plus": (89860.97, 10.96, 160.6, 339.9), "cortex-m4f": (47940.97, 9.05, 75.4, 171.36)},
    "gouraud": {"cortex-m0plus": (117095.27, 24.83, 172.95, 339.9), "cortex-m4f": (62934.99, 17.93, 68.45, 171.36)},
    "textured": {"cortex-m0plus": (179941.24, 31.01, 1479.91, 339.9), "cortex-m4f": (84049.93, 17.34, 672.63, 171.36)},
}
"""Instructions by shading and core: of a frame, and for each pixel, row of a triangle, and triangle."""

CODE_SOURCE = "arm-none-eabi-gcc 12.2.1, cortex-m0plus, -Os"
CODE_OPTIONS: dict[str, int] = {
    "all": 16383,
    "no-gouraud": 15549,
    "no-texture": 13811,
    "no-dither": 16279,
    "no-overdraw": 16357,
    "no-light": 16043,
    "no-orthographic": 15909,
    "no-stats": 16199,
    "no-carry": 16105,
    "gouraud": 13109,
    "flat": 11935,
    "flat-smallest": 11505,
}
"""Bytes of the renderer by its options; empty where they are not measured."""
CODE_PANELS: dict[str, int] = {
    "ili9341": 1350,
    "st7789": 1320,
    "st7789-240x240": 1320,
    "st7735": 1314,
    "ssd1306": 2096,
    "ssd0323": 2186,
}
CODE_STREAM = 13113
CODE_LIBC = 488


def el_bin_bytes(height: int, band_lines: int) -> int:
    """EL_BIN_BYTES of frame/renderer.h."""
    return el_round_up_8(2 * ((height + band_lines - 1) // band_lines))


def el_colour_band_bytes(width: int, band_lines: int) -> int:
    """EL_COLOUR_BAND_BYTES of frame/renderer.h."""
    return el_round_up_8(2 * width * band_lines)


def el_depth_band_bytes(width: int, band_lines: int) -> int:
    """EL_DEPTH_BAND_BYTES of frame/renderer.h."""
    return el_round_up_8(2 * width * band_lines)


def el_max_of(a: int, b: int) -> int:
    """EL_MAX_OF of frame/renderer.h."""
    return a if a > b else b


def el_memory_bytes(width: int, height: int, band_lines: int, vertices: int, triangles: int, draws: int) -> int:
    """EL_MEMORY_BYTES of frame/renderer.h."""
    return el_max_of(
        el_min_memory_bytes(width, height, band_lines),
        2 * el_colour_band_bytes(width, band_lines)
        + el_bin_bytes(height, band_lines)
        + el_max_of(el_depth_band_bytes(width, band_lines), el_round_up_8(vertices * EL_VERTEX_BYTES))
        + triangles * EL_TEXTURED_TRIANGLE_BYTES
        + draws * EL_RUN_BYTES
        + EL_MIN_LIST_BYTES // 2
        + 16,
    )


def el_min_memory_bytes(width: int, height: int, band_lines: int) -> int:
    """EL_MIN_MEMORY_BYTES of frame/renderer.h."""
    return (
        2 * el_colour_band_bytes(width, band_lines)
        + el_bin_bytes(height, band_lines)
        + el_depth_band_bytes(width, band_lines)
        + EL_MIN_LIST_BYTES
        + 8
    )


def el_mixed_words(width: int) -> int:
    """EL_MIXED_WORDS of raster/sample_memory.h."""
    return (width + 31) // 32


def el_round_up_8(bytes: int) -> int:
    """EL_ROUND_UP_8 of frame/renderer.h."""
    return (bytes + 7) // 8 * 8


def el_samples_bytes(width: int, band_lines: int, samples: int) -> int:
    """EL_SAMPLES_BYTES of frame/renderer.h."""
    return (
        0
        if samples < 2
        else el_round_up_8(4 * el_mixed_words(width) * band_lines) + el_round_up_8(4 * samples * width * band_lines)
    )


def el_split_buffer_bytes(width: int) -> int:
    """EL_SPLIT_BUFFER_BYTES of stream/split.h."""
    return (EL_SPLIT_FULL_BYTES + EL_SPLIT_MAX_GAP + el_split_line_max_bytes(width) + 1) // 2 * 2


def el_split_line_max_bytes(width: int) -> int:
    """EL_SPLIT_LINE_MAX_BYTES of stream/split.h."""
    return 2 * width + (width + 5) // 6


def el_ssd0323_memory_bytes(band_lines: int) -> int:
    """EL_SSD0323_MEMORY_BYTES of panel/ssd0323.h."""
    return 2 * 64 * band_lines


def el_ssd1306_memory_bytes(band_lines: int) -> int:
    """EL_SSD1306_MEMORY_BYTES of panel/ssd1306.h."""
    return 2 * 128 * el_ssd1306_pages(band_lines)


def el_ssd1306_pages(band_lines: int) -> int:
    """EL_SSD1306_PAGES of panel/ssd1306.h."""
    return 1 if 8 % band_lines == 0 else band_lines // 8 if band_lines % 8 == 0 else (band_lines + 14) // 8


def el_stream_build_bytes(width: int) -> int:
    """EL_STREAM_BUILD_BYTES of stream/session.h."""
    return 2 * width + el_split_buffer_bytes(width)


def el_stream_memory_bytes(width: int, height: int) -> int:
    """EL_STREAM_MEMORY_BYTES of stream/session.h."""
    return 3 + 4 * height + (height + 7) // 8 + el_stream_build_bytes(width)
