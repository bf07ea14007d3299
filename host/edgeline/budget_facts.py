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
    32: {"el_renderer": 416, "el_tft": 72, "el_oled": 44, "el_stream": 1476},
    64: {"el_renderer": 512, "el_tft": 112, "el_oled": 64, "el_stream": 1568},
}
"""By the bits of a pointer: 32 on microcontrollers, 64 in the simulator."""

FRAMES_SOURCE = "tests/bench/run --record-scenes, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

FRAMES: dict[str, tuple[str, dict[str, int]]] = {
    "S1": (
        "sphere of 1,024 triangles, Gouraud, depth",
        {
            "cortex-m0plus": 2551484,
            "cortex-m3": 1402809,
            "cortex-m4f": 1402125,
            "cortex-m7": 1417859,
            "cortex-m33": 1404105,
            "rv32imc": 1779982,
        },
    ),
    "S2": (
        "room of 12 triangles, textured, full screen, depth",
        {
            "cortex-m0plus": 7057240,
            "cortex-m3": 3332722,
            "cortex-m4f": 3310181,
            "cortex-m7": 3321196,
            "cortex-m33": 3363797,
            "rv32imc": 4354126,
        },
    ),
    "S2-no-depth": (
        "S2 without depth",
        {
            "cortex-m0plus": 5520530,
            "cortex-m3": 2349247,
            "cortex-m4f": 2333818,
            "cortex-m7": 2345863,
            "cortex-m33": 2373511,
            "rv32imc": 3487188,
        },
    ),
    "S3": (
        "4,000 small triangles, flat, depth",
        {
            "cortex-m0plus": 18345488,
            "cortex-m3": 8465590,
            "cortex-m4f": 8466876,
            "cortex-m7": 8483044,
            "cortex-m33": 8511251,
            "rv32imc": 10521468,
        },
    ),
    "S4": (
        "4,000 triangles of which 403 are on the screen, flat, depth",
        {
            "cortex-m0plus": 4956750,
            "cortex-m3": 2251903,
            "cortex-m4f": 2252639,
            "cortex-m7": 2256976,
            "cortex-m33": 2263290,
            "rv32imc": 3115060,
        },
    ),
    "teapot": (
        "Newell's teapot, lit, Gouraud-shaded",
        {
            "cortex-m0plus": 6023242,
            "cortex-m3": 3122155,
            "cortex-m4f": 3128458,
            "cortex-m7": 3142015,
            "cortex-m33": 3127402,
            "rv32imc": 3714870,
        },
    ),
    "room": (
        "two textured rooms to walk through",
        {
            "cortex-m0plus": 18293782,
            "cortex-m3": 8040003,
            "cortex-m4f": 8012419,
            "cortex-m7": 8053043,
            "cortex-m33": 8121438,
            "rv32imc": 10841445,
        },
    ),
    "solid": (
        "a truncated icosahedron, one colour per face",
        {
            "cortex-m0plus": 1002587,
            "cortex-m3": 656198,
            "cortex-m4f": 688670,
            "cortex-m7": 658583,
            "cortex-m33": 654646,
            "rv32imc": 957279,
        },
    ),
    "field": (
        "an island of 2,592 small flat triangles",
        {
            "cortex-m0plus": 9847870,
            "cortex-m3": 4827418,
            "cortex-m4f": 4866986,
            "cortex-m7": 4856676,
            "cortex-m33": 4835384,
            "rv32imc": 5555556,
        },
    ),
}
"""Of scenes at 320 x 240: what they are, and instructions of their first frame by core."""

CODE_SOURCE = "arm-none-eabi-gcc 12.2.1, cortex-m0plus, -Os"
CODE_OPTIONS: dict[str, int] = {
    "all": 16166,
    "no-gouraud": 15230,
    "no-texture": 13419,
    "no-dither": 15948,
    "no-overdraw": 16136,
    "no-light": 15856,
    "no-orthographic": 15716,
    "no-stats": 15922,
    "no-carry": 15968,
    "gouraud": 12757,
    "flat": 11509,
    "flat-smallest": 11081,
}
"""Bytes of the renderer by its options; empty where they are not measured."""
CODE_PANELS: dict[str, int] = {
    "ili9341": 1272,
    "st7789": 1242,
    "st7789-240x240": 1242,
    "st7735": 1236,
    "ssd1306": 2040,
    "ssd0323": 2130,
}
CODE_STREAM = 13101
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


def el_round_up_8(bytes: int) -> int:
    """EL_ROUND_UP_8 of frame/renderer.h."""
    return (bytes + 7) // 8 * 8


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
