"""The meshes of the demo, by the names of their headers."""

from __future__ import annotations

from edgeline.convert.header import NamedMesh
from mesh_sources.field import field
from mesh_sources.room import room
from mesh_sources.solid import solid
from mesh_sources.teapot import teapot

ABOUT = {
    "teapot": "Martin Newell's teapot, from its Bezier patches, with normals; 6.5 units wide, y up.",
    "room": "Two rooms with a doorway to walk through: 10 x 10 x 3 units, floor at y = 0, textured.",
    "solid": "A truncated icosahedron of radius 1, a colour and a normal for each of its 32 faces.",
    "field": "An island of 10 x 10 units, sea at y = 0, with vertex colours and normals.",
}


def all_meshes() -> dict[str, NamedMesh]:
    return {named.name: named for named in (teapot(), room(), solid(), field())}
