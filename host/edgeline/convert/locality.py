"""How often the firmware transforms a vertex when a mesh is too large to be kept whole (`frame/vertices.c`).

Then its vertices go through a cache with a place for each number modulo the places, and where they are asked for one
after the other, the next are brought along.
"""

from __future__ import annotations

from edgeline import budget_facts as facts
from edgeline.convert.mesh import Mesh

WIDTH, BAND = 320, 8
INDEX_BYTES = 2
AHEAD = 16


def cache_slots(width: int = WIDTH, band: int = BAND) -> int:
    """The places that there are at least: those that the depth band has room for."""
    places = facts.el_depth_band_bytes(width, band) // (facts.EL_VERTEX_BYTES + INDEX_BYTES)
    return 1 << (places.bit_length() - 1)


def transforms(mesh: Mesh, slots: int) -> int:
    """Vertices that are transformed for one pass through the mesh's triangles, none of them skipped."""
    held = [-1] * slots
    total, following, count = 0, -1, len(mesh.positions)
    for index in mesh.triangles.reshape(-1).tolist():
        slot = index % slots
        if held[slot] == index:
            continue
        run = min(count - index, slots - slot, AHEAD) if index == following else 1
        for i in range(run):
            held[slot + i] = index + i
        following = index + run
        total += run
    return total


def per_triangle(mesh: Mesh) -> float:
    """`transforms` in the cache of 320 x 240 in bands of 8, by the number of triangles."""
    return transforms(mesh, cache_slots()) / len(mesh.triangles)
