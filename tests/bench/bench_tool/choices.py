"""What is compared: groups of ways to do the same, how each is called, and by which error they are compared."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Group:
    title: str
    error: str  # the error to compare by: its key in the scores
    error_title: str
    chosen: str
    choices: dict[str, str]  # name in the program's output, title


_TEXTURE = {
    "bound2": "bound 1/2 texel",
    "bound4": "bound 1/4",
    "bound8": "bound 1/8",
    "bound16": "bound 1/16",
    "bound32": "bound 1/32",
    "affine": "affine",
    "fixed16": "every 16 px",
    "fixed8": "every 8 px",
    "per_pixel": "division per pixel",
}


def _texture(title: str) -> Group:
    return Group(title, "max_texels", "largest error, texels", "bound8", _TEXTURE)


GROUPS = {
    "edges": Group(
        "span walking",
        "wrong_per_1000_edge_pixels",
        "wrong pixels per 1000 edge pixels",
        "exact",
        {"exact": "exact, 64-bit slopes", "rounded": "16.16 slopes", "tests": "edge test per pixel"},
    ),
    "subpixel": Group(
        "sub-pixel bits, against unsnapped corners",
        "wrong_per_1000_edge_pixels",
        "wrong pixels per 1000 edge pixels",
        "bits4",
        {"bits4": "4 bits", "bits6": "6 bits", "bits8": "8 bits"},
    ),
    "depth": Group(
        "depth",
        "not_nearest_per_million",
        "pixels per million not correctly rounded",
        "wide_step",
        {
            "wide_step": "64-bit step",
            "rounded_step": "16.16 step, rounded",
            "floored_step": "16.16 step, floored",
            "evaluated": "evaluated per pixel",
        },
    ),
    "gouraud": Group(
        "vertex colours",
        "max_255ths",
        "largest error, 1/255",
        "per_channel",
        {"per_channel": "per channel, 8.24", "packed": "two words, 8.8", "packed_anchored": "two words, every 16 px"},
    ),
    "dither": Group(
        "dithering to RGB565",
        "max_block_255ths",
        "largest error of a 4x4 block's mean, 1/255",
        "off",
        {"off": "off", "on": "on"},
    ),
    "texture_walls": _texture("texture, walls: 1/w within a factor of 8"),
    "texture_steep": _texture("texture, steep walls: a factor of 128"),
    "texture_small": _texture("texture, triangles of at most 6 px"),
    "reciprocal": Group(
        "reciprocal of 32 bits",
        "max_ulp",
        "largest error, units of 2^-31",
        "exact",
        {
            "exact": "Möller-Granlund",
            "division64": "64-bit division",
            "division32": "32-bit division",
            "table": "table of 256",
            "table_newton1": "table, 1 Newton step",
            "table_newton2": "table, 2 Newton steps",
        },
    ),
    "smoothing": Group(
        "smooth edges, S1",
        "rms_255ths",
        "error against 256 samples, rms, 1/255",
        "samples_1",
        {
            "samples_1": "1 sample per pixel",
            "samples_4": "4 samples",
            "samples_8": "8 samples",
            "stripes": "RGB stripes",
            "stripes_4": "RGB stripes, 4 samples",
        },
    ),
}

# The renderer's own loop, measured beside the group's copy of it: another cost, for it does more, the same pixels.
RENDERER = "renderer"
