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
            "cortex-m0plus": 1585791,
            "cortex-m3": 900002,
            "cortex-m4f": 874056,
            "cortex-m7": 879490,
            "cortex-m33": 884508,
            "rv32imc": 1309681,
        },
    ),
    "S2": (
        "room of 12 triangles, textured, full screen, depth",
        {
            "cortex-m0plus": 4568192,
            "cortex-m3": 2298399,
            "cortex-m4f": 2303232,
            "cortex-m7": 2299290,
            "cortex-m33": 2314791,
            "rv32imc": 3440718,
        },
    ),
    "S2-no-depth": (
        "S2 without depth",
        {
            "cortex-m0plus": 3970828,
            "cortex-m3": 1825771,
            "cortex-m4f": 1821856,
            "cortex-m7": 1825567,
            "cortex-m33": 1831422,
            "rv32imc": 2771624,
        },
    ),
    "S3": (
        "4,000 small triangles, flat, depth",
        {
            "cortex-m0plus": 7884775,
            "cortex-m3": 4039314,
            "cortex-m4f": 3994149,
            "cortex-m7": 4072633,
            "cortex-m33": 3989853,
            "rv32imc": 4960286,
        },
    ),
    "S4": (
        "4,000 triangles of which 403 are on the screen, flat, depth",
        {
            "cortex-m0plus": 1584780,
            "cortex-m3": 833542,
            "cortex-m4f": 819486,
            "cortex-m7": 826163,
            "cortex-m33": 830656,
            "rv32imc": 1217697,
        },
    ),
    "teapot": (
        "Newell's teapot, lit, Gouraud-shaded",
        {
            "cortex-m0plus": 3594005,
            "cortex-m3": 1964931,
            "cortex-m4f": 1914519,
            "cortex-m7": 1928539,
            "cortex-m33": 1942668,
            "rv32imc": 2563926,
        },
    ),
    "room": (
        "two textured rooms to walk through",
        {
            "cortex-m0plus": 12739454,
            "cortex-m3": 6225621,
            "cortex-m4f": 6215152,
            "cortex-m7": 6164150,
            "cortex-m33": 6256356,
            "rv32imc": 8560953,
        },
    ),
    "solid": (
        "a truncated icosahedron, one colour per face",
        {
            "cortex-m0plus": 905723,
            "cortex-m3": 540184,
            "cortex-m4f": 538499,
            "cortex-m7": 539931,
            "cortex-m33": 538075,
            "rv32imc": 925530,
        },
    ),
    "field": (
        "an island of 2,592 small flat triangles",
        {
            "cortex-m0plus": 5899132,
            "cortex-m3": 3084738,
            "cortex-m4f": 3034938,
            "cortex-m7": 3074544,
            "cortex-m33": 3038978,
            "rv32imc": 3697599,
        },
    ),
    "S1-4x": (
        "S1 with 4 samples per pixel",
        {
            "cortex-m0plus": 3216168,
            "cortex-m3": 1936311,
            "cortex-m4f": 1914411,
            "cortex-m7": 1929453,
            "cortex-m33": 1918543,
            "rv32imc": 2649359,
        },
    ),
    "S3-4x": (
        "S3 with 4 samples per pixel",
        {
            "cortex-m0plus": 31474301,
            "cortex-m3": 17881842,
            "cortex-m4f": 17865097,
            "cortex-m7": 18060368,
            "cortex-m33": 17831487,
            "rv32imc": 22772923,
        },
    ),
    "teapot-4x": (
        "teapot with 4 samples per pixel",
        {
            "cortex-m0plus": 7665681,
            "cortex-m3": 4547170,
            "cortex-m4f": 4513290,
            "cortex-m7": 4548975,
            "cortex-m33": 4523761,
            "rv32imc": 5809822,
        },
    ),
    "room-4x": (
        "room with 4 samples per pixel",
        {
            "cortex-m0plus": 66933231,
            "cortex-m3": 30804673,
            "cortex-m4f": 31038682,
            "cortex-m7": 30609525,
            "cortex-m33": 31085961,
            "rv32imc": 34030398,
        },
    ),
    "S1-8x": (
        "S1 with 8 samples per pixel",
        {
            "cortex-m0plus": 4380857,
            "cortex-m3": 2727035,
            "cortex-m4f": 2683317,
            "cortex-m7": 2694540,
            "cortex-m33": 2724157,
            "rv32imc": 3504897,
        },
    ),
}
"""Of scenes at 320 x 240: what they are, and instructions of their first frame by core."""

LAWS_SOURCE = "tests/bench/run --record-growth, arm-none-eabi-gcc 12.2.1, QEMU 7.2.22"

LAWS: dict[str, dict[str, tuple[float, float, float, float]]] = {
    "flat": {"cortex-m0plus": (90579.66, 10.96, 160.61, 339.91), "cortex-m4f": (48003.6, 9.05, 75.4, 171.36)},
    "gouraud": {"cortex-m0plus": (117791.78, 24.82, 173.1, 339.91), "cortex-m4f": (62995.96, 17.93, 68.46, 171.36)},
    "textured": {"cortex-m0plus": (180645.73, 31.01, 1480.01, 339.91), "cortex-m4f": (84110.45, 17.34, 672.64, 171.36)},
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
