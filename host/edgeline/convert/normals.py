"""Vertex normals of models that bring none: area-weighted means over the faces that meet smoothly.

The normal of a face's corner takes in those faces around the vertex that turn from it by no more than the crease angle;
so an edge of a cube stays sharp while a sphere becomes round, whatever the file says about smoothing.
"""

from __future__ import annotations

import math

import numpy as np

from edgeline.convert.mesh import Floats, Ints, weld

PAIRS_AT_ONCE = 1 << 20


def unit(vectors: Floats) -> Floats:
    """`vectors` (..., 3) with length 1; those without length become +z, so that every normal is one."""
    lengths = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True))
    safe = np.where(lengths > 0, lengths, 1.0)
    return np.where(lengths > 0, vectors / safe, np.array([0.0, 0.0, 1.0]))


def face_vectors(positions: Floats) -> Floats:
    """Per triangle of (m, 3, 3) its normal with twice its area as length."""
    return np.asarray(np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]))


def corner_groups(positions: Floats) -> list[Ints]:
    """Arrays (vertices, valence) of corner numbers (0..3m) that share a position, one array per valence."""
    _, vertex_of = weld(positions.reshape(-1, 3) + 0.0)  # -0.0 becomes 0.0
    order = np.argsort(vertex_of, kind="stable")
    counts = np.bincount(vertex_of)
    starts = np.cumsum(counts) - counts
    return [
        order[starts[counts == valence][:, None] + np.arange(valence)].astype(np.int64) for valence in np.unique(counts)
    ]


def smooth_normals(positions: Floats, crease_degrees: float) -> Floats:
    """Unit normals (m, 3, 3) for the corners of the triangles `positions` (m, 3, 3)."""
    weighted = np.repeat(face_vectors(positions), 3, axis=0)
    units = unit(weighted)
    least_cosine = math.cos(math.radians(crease_degrees)) - 1e-9
    sums = np.zeros_like(weighted)
    for corners in corner_groups(positions):
        valence = corners.shape[1]
        step = max(1, PAIRS_AT_ONCE // (valence * valence))
        for first in range(0, len(corners), step):
            group = corners[first : first + step]
            for row in range(valence):
                cosines = (units[group[:, row], None] * units[group]).sum(axis=2)
                near = (cosines >= least_cosine)[:, :, None]
                sums[group[:, row]] = (weighted[group] * near).sum(axis=1)
    lost = (sums == 0).all(axis=1)
    sums[lost] = weighted[lost]
    return unit(sums).reshape(positions.shape)
