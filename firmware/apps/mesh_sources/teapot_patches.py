"""The control points of the teapot that Martin Newell measured and drew in 1975 (the Utah teapot), z up.

The numbers are his, as published by F. Crow, "The origins of the teapot", IEEE Computer Graphics and Applications 7(1),
1987: 32 bicubic Bezier patches with 306 different control points. Body and lid are turned, so here a row of them is
one ring: (radius, tangent, height), with the points (r, 0), (r, t), (t, r), (0, r) in the first quarter. The tangent is
0.56 of the radius, except in the knob, where the data have 0.45 for 0.8. Handle and spout are given on one side
(y <= 0) as rows across; the other side is their mirror image.
"""

from __future__ import annotations

Ring = tuple[float, float, float]
Row = tuple[tuple[float, float, float], ...]

BODY: tuple[Ring, ...] = (  # from the rim's inner edge over the belly to the middle of the bottom: four patches
    (1.4, 0.784, 2.4), (1.3375, 0.749, 2.53125), (1.4375, 0.805, 2.53125),
    (1.5, 0.84, 2.4), (1.75, 0.98, 1.875), (2.0, 1.12, 1.35),
    (2.0, 1.12, 0.9), (2.0, 1.12, 0.45), (1.5, 0.84, 0.225),
    (1.5, 0.84, 0.15), (1.5, 0.84, 0.075), (1.425, 0.798, 0.0),
    (0.0, 0.0, 0.0),
)  # fmt: skip

LID: tuple[Ring, ...] = (  # from the top of the knob to the lid's edge: two patches
    (0.0, 0.0, 3.15), (0.8, 0.45, 3.15), (0.0, 0.0, 2.85),
    (0.2, 0.112, 2.7), (0.4, 0.224, 2.55), (1.3, 0.728, 2.55),
    (1.3, 0.728, 2.4),
)  # fmt: skip

HANDLE: tuple[Row, ...] = (  # from its upper end to its lower end: two patches
    ((-1.6, 0.0, 2.025), (-1.6, -0.3, 2.025), (-1.5, -0.3, 2.25), (-1.5, 0.0, 2.25)),
    ((-2.3, 0.0, 2.025), (-2.3, -0.3, 2.025), (-2.5, -0.3, 2.25), (-2.5, 0.0, 2.25)),
    ((-2.7, 0.0, 2.025), (-2.7, -0.3, 2.025), (-3.0, -0.3, 2.25), (-3.0, 0.0, 2.25)),
    ((-2.7, 0.0, 1.8), (-2.7, -0.3, 1.8), (-3.0, -0.3, 1.8), (-3.0, 0.0, 1.8)),
    ((-2.7, 0.0, 1.575), (-2.7, -0.3, 1.575), (-3.0, -0.3, 1.35), (-3.0, 0.0, 1.35)),
    ((-2.5, 0.0, 1.125), (-2.5, -0.3, 1.125), (-2.65, -0.3, 0.9375), (-2.65, 0.0, 0.9375)),
    ((-2.0, 0.0, 0.9), (-2.0, -0.3, 0.9), (-1.9, -0.3, 0.6), (-1.9, 0.0, 0.6)),
)

SPOUT: tuple[Row, ...] = (  # from the body to the tip: two patches
    ((1.7, 0.0, 1.425), (1.7, -0.66, 1.425), (1.7, -0.66, 0.6), (1.7, 0.0, 0.6)),
    ((2.6, 0.0, 1.425), (2.6, -0.66, 1.425), (3.1, -0.66, 0.825), (3.1, 0.0, 0.825)),
    ((2.3, 0.0, 2.1), (2.3, -0.25, 2.1), (2.4, -0.25, 2.025), (2.4, 0.0, 2.025)),
    ((2.7, 0.0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0.0, 2.4)),
    ((2.8, 0.0, 2.475), (2.8, -0.25, 2.475), (3.525, -0.25, 2.49375), (3.525, 0.0, 2.49375)),
    ((2.9, 0.0, 2.475), (2.9, -0.15, 2.475), (3.45, -0.15, 2.5125), (3.45, 0.0, 2.5125)),
    ((2.8, 0.0, 2.4), (2.8, -0.15, 2.4), (3.2, -0.15, 2.4), (3.2, 0.0, 2.4)),
)
