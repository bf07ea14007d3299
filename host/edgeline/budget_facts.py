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
    32: {"el_renderer": 424, "el_tft": 72, "el_oled": 44, "el_stream": 1476},
    64: {"el_renderer": 528, "el_tft": 112, "el_oled": 64, "el_stream": 1568},
}
"""By the bits of a pointer: 32 on microcontrollers, 64 in the simulator."""

FRAMES_SOURCE = "tests/bench/run --record-scenes, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

FRAMES: dict[str, tuple[str, dict[str, int]]] = {
    "S1": (
        "sphere of 1,024 triangles, Gouraud, depth",
        {
            "cortex-m0plus": 1864982,
            "cortex-m3": 1064832,
            "cortex-m4f": 1043459,
            "cortex-m7": 1039811,
            "cortex-m33": 1047886,
            "rv32imc": 1453524,
        },
    ),
    "S2": (
        "room of 12 triangles, textured, full screen, depth",
        {
            "cortex-m0plus": 4902594,
            "cortex-m3": 2421942,
            "cortex-m4f": 2446829,
            "cortex-m7": 2413538,
            "cortex-m33": 2433426,
            "rv32imc": 3709850,
        },
    ),
    "S2-no-depth": (
        "S2 without depth",
        {
            "cortex-m0plus": 4208021,
            "cortex-m3": 1922088,
            "cortex-m4f": 1950709,
            "cortex-m7": 1919669,
            "cortex-m33": 1933572,
            "rv32imc": 2989485,
        },
    ),
    "S3": (
        "4,000 small triangles, flat, depth",
        {
            "cortex-m0plus": 10458257,
            "cortex-m3": 5476161,
            "cortex-m4f": 5295079,
            "cortex-m7": 5295521,
            "cortex-m33": 5323430,
            "rv32imc": 6543519,
        },
    ),
    "S4": (
        "4,000 triangles of which 403 are on the screen, flat, depth",
        {
            "cortex-m0plus": 2722083,
            "cortex-m3": 1509235,
            "cortex-m4f": 1492877,
            "cortex-m7": 1502697,
            "cortex-m33": 1494471,
            "rv32imc": 2173249,
        },
    ),
    "teapot": (
        "Newell's teapot, lit, Gouraud-shaded",
        {
            "cortex-m0plus": 4343435,
            "cortex-m3": 2351831,
            "cortex-m4f": 2300986,
            "cortex-m7": 2293397,
            "cortex-m33": 2311809,
            "rv32imc": 2930661,
        },
    ),
    "room": (
        "two textured rooms to walk through",
        {
            "cortex-m0plus": 14479480,
            "cortex-m3": 6775948,
            "cortex-m4f": 6799662,
            "cortex-m7": 6765734,
            "cortex-m33": 6797105,
            "rv32imc": 9310446,
        },
    ),
    "solid": (
        "a truncated icosahedron, one colour per face",
        {
            "cortex-m0plus": 905698,
            "cortex-m3": 534800,
            "cortex-m4f": 532557,
            "cortex-m7": 530468,
            "cortex-m33": 532279,
            "rv32imc": 919598,
        },
    ),
    "field": (
        "an island of 2,592 small flat triangles",
        {
            "cortex-m0plus": 7369204,
            "cortex-m3": 3741921,
            "cortex-m4f": 3636904,
            "cortex-m7": 3628711,
            "cortex-m33": 3655356,
            "rv32imc": 4363090,
        },
    ),
}
"""Of scenes at 320 x 240: what they are, and instructions of their first frame by core."""

LAWS_SOURCE = "tests/bench/run --record-growth, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

LAWS: dict[str, dict[str, tuple[float, float, float, float]]] = {
    "flat": {"cortex-m0plus": (93306.94, 12.23, 133.35, 465.09), "cortex-m4f": (50193.18, 9.66, 53.95, 240.64)},
    "gouraud": {"cortex-m0plus": (123691.04, 25.46, 214.71, 465.09), "cortex-m4f": (67463.19, 18.94, 89.11, 240.64)},
    "textured": {"cortex-m0plus": (165967.27, 25.37, 2038.68, 465.09), "cortex-m4f": (80139.84, 15.19, 865.14, 240.64)},
}
"""Instructions by shading and core: of a frame, and for each pixel, row of a triangle, and triangle."""

CODE_SOURCE = "arm-none-eabi-gcc 12.2.1, cortex-m0plus, -Os"
CODE_OPTIONS: dict[str, int] = {
    "all": 16367,
    "no-gouraud": 15537,
    "no-texture": 13783,
    "no-dither": 16269,
    "no-overdraw": 16347,
    "no-light": 16043,
    "no-orthographic": 15893,
    "no-stats": 16177,
    "no-carry": 16097,
    "gouraud": 13087,
    "flat": 11943,
    "flat-smallest": 11495,
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
