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
            "cortex-m0plus": 1581478,
            "cortex-m3": 896062,
            "cortex-m4f": 870376,
            "cortex-m7": 875425,
            "cortex-m33": 880283,
            "rv32imc": 1308131,
        },
    ),
    "S2": (
        "room of 12 triangles, textured, full screen, depth",
        {
            "cortex-m0plus": 4575848,
            "cortex-m3": 2300133,
            "cortex-m4f": 2304868,
            "cortex-m7": 2300790,
            "cortex-m33": 2316504,
            "rv32imc": 3444590,
        },
    ),
    "S2-no-depth": (
        "S2 without depth",
        {
            "cortex-m0plus": 3978618,
            "cortex-m3": 1827489,
            "cortex-m4f": 1823476,
            "cortex-m7": 1825959,
            "cortex-m33": 1833119,
            "rv32imc": 2775482,
        },
    ),
    "S3": (
        "4,000 small triangles, flat, depth",
        {
            "cortex-m0plus": 7894700,
            "cortex-m3": 4047804,
            "cortex-m4f": 4003021,
            "cortex-m7": 4066099,
            "cortex-m33": 3998314,
            "rv32imc": 4967269,
        },
    ),
    "S4": (
        "4,000 triangles of which 403 are on the screen, flat, depth",
        {
            "cortex-m0plus": 1576833,
            "cortex-m3": 832989,
            "cortex-m4f": 820323,
            "cortex-m7": 825239,
            "cortex-m33": 830074,
            "rv32imc": 1218391,
        },
    ),
    "teapot": (
        "Newell's teapot, lit, Gouraud-shaded",
        {
            "cortex-m0plus": 3586000,
            "cortex-m3": 1956322,
            "cortex-m4f": 1906710,
            "cortex-m7": 1920178,
            "cortex-m33": 1933234,
            "rv32imc": 2558909,
        },
    ),
    "room": (
        "two textured rooms to walk through",
        {
            "cortex-m0plus": 12810921,
            "cortex-m3": 6244394,
            "cortex-m4f": 6233505,
            "cortex-m7": 6182127,
            "cortex-m33": 6275237,
            "rv32imc": 8587316,
        },
    ),
    "solid": (
        "a truncated icosahedron, one colour per face",
        {
            "cortex-m0plus": 902576,
            "cortex-m3": 538518,
            "cortex-m4f": 536837,
            "cortex-m7": 538052,
            "cortex-m33": 536380,
            "rv32imc": 925966,
        },
    ),
    "field": (
        "an island of 2,592 small flat triangles",
        {
            "cortex-m0plus": 5900128,
            "cortex-m3": 3085060,
            "cortex-m4f": 3035310,
            "cortex-m7": 3066733,
            "cortex-m33": 3039294,
            "rv32imc": 3698661,
        },
    ),
}
"""Of scenes at 320 x 240: what they are, and instructions of their first frame by core."""

LAWS_SOURCE = "tests/bench/run --record-growth, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

LAWS: dict[str, dict[str, tuple[float, float, float, float]]] = {
    "flat": {"cortex-m0plus": (87865.2, 10.96, 160.56, 341.24), "cortex-m4f": (46721.19, 9.06, 75.0, 177.57)},
    "gouraud": {"cortex-m0plus": (115070.34, 24.86, 172.07, 341.24), "cortex-m4f": (61598.74, 17.96, 67.75, 177.57)},
    "textured": {"cortex-m0plus": (177660.25, 31.05, 1488.24, 341.24), "cortex-m4f": (82503.24, 17.36, 675.08, 177.57)},
}
"""Instructions by shading and core: of a frame, and for each pixel, row of a triangle, and triangle."""

CODE_SOURCE = "arm-none-eabi-gcc 12.2.1, cortex-m0plus, -Os"
CODE_OPTIONS: dict[str, int] = {
    "all": 16363,
    "no-gouraud": 15539,
    "no-texture": 13791,
    "no-dither": 16267,
    "no-overdraw": 16347,
    "no-light": 16021,
    "no-orthographic": 15889,
    "no-stats": 16173,
    "no-carry": 16093,
    "gouraud": 13093,
    "flat": 11921,
    "flat-smallest": 11489,
}
"""Bytes of the renderer by its options; empty where they are not measured."""
CODE_PANELS: dict[str, int] = {
    "ili9341": 1348,
    "st7789": 1318,
    "st7789-240x240": 1318,
    "st7735": 1312,
    "ssd1306": 2088,
    "ssd0323": 2178,
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
    """EL_MIXED_WORDS of raster/samples.h."""
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
