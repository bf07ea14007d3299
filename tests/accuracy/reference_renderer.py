"""A renderer in float64 that knows how sure it is: for each pixel what must be there, and what may be.

Camera: right-handed, along -z, y up, `fov` is the whole vertical angle; counter-clockwise faces are drawn; the screen's
y points down, its origin is the upper left corner. Depth is 65534 * far / (far - near) * (1 - near / distance), 0 near.

The simulator rounds each vertex to 1/16 px, so a vertex moves by at most sqrt(2)/32 = 0.044 px; with its own arithmetic
it is granted MOVE = 1/16 px. From this follows, without looking at how it works:

* A front face that stays one under any such move is sure; a face that may turn away is a maybe.
* The sure faces over a pixel's centre are counted by how often their outline winds around it. An edge between two sure
  faces is no outline, however it moves. So whether a pixel is covered can change only where an outline edge, that is,
  one without a sure partner, or a maybe passes within MOVE of the centre. Cracks along inner edges are never excused.
* Inside a moved face an attribute has the value that it had at a point up to MOVE away, so it changes by at most its
  gradient times MOVE.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Hashable, Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from elm_file import ElmMesh

Floats = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

MOVE = 1 / 16
"""px by which a projected vertex may be off, Euclidean."""

DEPTH_MAX = 65534
DEPTH_SLACK = 1.125
"""Units of depth: half a unit of rounding in the vertices, half in the pixel, 1/8 for the vertices' arithmetic."""


@dataclass(frozen=True)
class Camera:
    """Eye and target in world units, the whole vertical field of view in degrees, near and far distance."""

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    fov: float
    near: float
    far: float

    def arguments(self) -> list[str]:
        """The simulator's command line for it."""
        eye, target = (",".join(f"{value:.10g}" for value in point) for point in (self.eye, self.target))
        numbers = [f"{value:.10g}" for value in (self.fov, self.near, self.far)]
        return [
            f"--eye={eye}",
            f"--look-at={target}",
            f"--fov={numbers[0]}",
            f"--near={numbers[1]}",
            f"--far={numbers[2]}",
        ]

    def view(self, points: Floats) -> Floats:
        """Right, up and distance of world points, shape (n, 3)."""
        eye = np.array(self.eye)
        forward = np.array(self.target) - eye
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 1.0, 0.0])
        right /= np.linalg.norm(right)
        return np.asarray((points - eye) @ np.stack([right, np.cross(right, forward), forward]).T)


@dataclass
class Picture:
    """Per pixel, all of shape (height, width). Depths are bounds in 16-bit units, infinite where nothing may be."""

    covered: Mask
    """The centre lies in at least one sure face."""
    outline: Mask
    """An outline edge passes within MOVE of the centre."""
    solid: Mask
    """All within MOVE of the centre lies in one sure face."""
    least: Floats
    """No depth below may appear."""
    most: Floats
    """No depth above may appear, where the pixel is covered."""
    uv: Floats
    """(height, width, 2): texels of the nearest face, NaN where it is not sure which face that is."""
    uv_error: Floats
    """By how much uv may be off because of the moves; same shape."""


@dataclass
class _Piece:
    """A projected face or a piece of a clipped one. Screen x, y in px; planes as (value at origin, d/dx, d/dy)."""

    corners: Floats
    keys: list[Hashable]
    depths: Floats
    sure: bool
    planes: dict[str, Floats] = field(default_factory=dict)


def render(mesh: ElmMesh, camera: Camera, width: int, height: int) -> Picture:
    """What a mesh in its own place looks like from `camera`."""
    pieces = list(_pieces(mesh, camera, width, height))
    shape = (height, width)
    picture = Picture(
        covered=np.zeros(shape, np.bool_),
        outline=_near_outline(pieces, width, height),
        solid=np.zeros(shape, np.bool_),
        least=np.full(shape, np.inf),
        most=np.full(shape, np.inf),
        uv=np.full((*shape, 2), np.nan),
        uv_error=np.full((*shape, 2), np.inf),
    )
    nearest_most = np.full(shape, np.inf)
    nearest_solid = np.zeros(shape, np.bool_)
    second_least = np.full(shape, np.inf)
    any_most = np.full(shape, -np.inf)
    for piece in pieces:
        window = _window(piece.corners, width, height)
        if window is None:
            continue
        x, y = _centres(window)
        margin = _margin(piece.corners, x, y)
        possible = _reach(piece.corners, x, y)
        solid = (margin >= MOVE) & piece.sure
        depth = _at(piece.planes["depth"], x, y)
        # The plane of a maybe may turn to any side: nothing is sure but its corners' range.
        blur = MOVE * math.hypot(*piece.planes["depth"][1:]) + DEPTH_SLACK if piece.sure else math.inf
        least = np.where(possible, np.maximum(depth - blur, piece.depths.min() - DEPTH_SLACK), np.inf)
        most = np.minimum(depth + blur, piece.depths.max() + DEPTH_SLACK)

        picture.covered[window] |= (margin >= -1e-9) & piece.sure
        picture.solid[window] |= solid
        picture.most[window] = np.where(solid, np.minimum(picture.most[window], most), picture.most[window])
        any_most[window] = np.where(possible, np.maximum(any_most[window], most), any_most[window])

        nearer = least < picture.least[window]
        second_least[window] = np.where(nearer, picture.least[window], np.minimum(second_least[window], least))
        picture.least[window] = np.where(nearer, least, picture.least[window])
        nearest_most[window] = np.where(nearer, most, nearest_most[window])
        nearest_solid[window] = np.where(nearer, solid, nearest_solid[window])
        if "u" in piece.planes:
            uv, uv_error = _texture_coordinates(piece, x, y)
            picture.uv[window] = np.where(nearer[..., np.newaxis], uv, picture.uv[window])
            picture.uv_error[window] = np.where(nearer[..., np.newaxis], uv_error, picture.uv_error[window])
    picture.most = np.where(np.isfinite(picture.most), picture.most, any_most)
    picture.uv[~(nearest_solid & (nearest_most < second_least))] = np.nan
    return picture


def is_before_far(mesh: ElmMesh, camera: Camera) -> bool:
    """Whether nothing reaches the far plane: the reference does not clip there."""
    return bool(camera.view(_world(mesh))[:, 2].max() < camera.far)


def _world(mesh: ElmMesh) -> Floats:
    return np.asarray(mesh.positions.astype(np.float64) * 2.0**mesh.scale_log2)


def _pieces(mesh: ElmMesh, camera: Camera, width: int, height: int) -> Iterator[_Piece]:
    """All faces and pieces of faces in front of the near plane that may be front faces."""
    assert is_before_far(mesh, camera)
    points = camera.view(_world(mesh))
    focal = height / 2 / math.tan(math.radians(camera.fov) / 2)
    scale = DEPTH_MAX * camera.far / (camera.far - camera.near)
    places = [tuple(position) for position in mesh.positions.tolist()]
    for triangle in mesh.triangles:
        polygon = [(points[k], _uv(mesh, k), places[k]) for k in triangle]
        polygon = _clip(polygon, camera.near)
        for k in range(1, len(polygon) - 1):
            corners = [polygon[0], polygon[k], polygon[k + 1]]
            view = np.array([corner[0] for corner in corners])
            x = width / 2 + focal * view[:, 0] / view[:, 2]
            y = height / 2 - focal * view[:, 1] / view[:, 2]
            screen = np.stack([x, y], axis=1)
            facing = _facing(screen)
            if facing < 0:
                continue
            w = 1 / view[:, 2]
            depths = scale * (1 - camera.near * w)
            piece = _Piece(screen, [corner[2] for corner in corners], depths, facing > 0)
            attributes = {"depth": depths, "w": w}
            if mesh.uvs is not None:
                uv = np.array([corner[1] for corner in corners])
                attributes |= {"u": uv[:, 0] * w, "v": uv[:, 1] * w}
            piece.planes = _planes(screen, attributes)
            yield piece


def _uv(mesh: ElmMesh, index: int) -> Floats:
    return mesh.uvs[index] / 16.0 if mesh.uvs is not None else np.zeros(2)


_Corner = tuple[Floats, Floats, Hashable]


def _clip(polygon: list[_Corner], near: float) -> list[_Corner]:
    """Sutherland and Hodgman at distance = near. A new corner's key is its edge's, whichever way the edge is walked."""
    kept: list[_Corner] = []
    for (p, p_uv, p_key), (q, q_uv, q_key) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        if p[2] >= near:
            kept.append((p, p_uv, p_key))
        if (p[2] >= near) != (q[2] >= near):
            t = (near - p[2]) / (q[2] - p[2])
            kept.append((p + t * (q - p), p_uv + t * (q_uv - p_uv), frozenset((p_key, q_key))))
    return kept


def _facing(screen: Floats) -> int:
    """1 for a front face that stays one when its corners move by MOVE, -1 for a back face that does, else 0.

    Moving the corners changes each edge by at most 2 MOVE, and so the cross product of two edges by at most
    2 MOVE (|e| + |f|) + 4 MOVE^2. Counter-clockwise is negative where y points down.
    """
    e, f = screen[1] - screen[0], screen[2] - screen[0]
    twice_area = -(e[0] * f[1] - e[1] * f[0])
    change = 2 * MOVE * (math.hypot(*e) + math.hypot(*f)) + 4 * MOVE * MOVE
    return 0 if abs(twice_area) <= change else (1 if twice_area > 0 else -1)


def _planes(screen: Floats, attributes: dict[str, Floats]) -> dict[str, Floats]:
    """Each attribute as a plane over the screen; a face seen edge-on gets the mean and no gradient."""
    matrix = np.column_stack([np.ones(3), screen])
    if abs(np.linalg.det(matrix)) < 1e-9:
        return {name: np.array([float(values.mean()), 0.0, 0.0]) for name, values in attributes.items()}
    return {name: np.linalg.solve(matrix, values).astype(np.float64) for name, values in attributes.items()}


_Window = tuple[slice, slice]


def _window(corners: Floats, width: int, height: int) -> _Window | None:
    """The pixels whose centres lie within 1 px of the corners' bounding box."""
    x0, y0 = (max(math.floor(value) - 1, 0) for value in corners.min(axis=0))
    x1, y1 = (math.ceil(value) + 1 for value in corners.max(axis=0))
    x1, y1 = min(x1, width), min(y1, height)
    return (slice(y0, y1), slice(x0, x1)) if x0 < x1 and y0 < y1 else None


def _centres(window: _Window) -> tuple[Floats, Floats]:
    y, x = np.mgrid[window]
    return x + 0.5, y + 0.5


def _at(plane: Floats, x: Floats, y: Floats) -> Floats:
    return np.asarray(plane[0] + plane[1] * x + plane[2] * y)


def _margin(corners: Floats, x: Floats, y: Floats) -> Floats:
    """Signed distance to the nearest edge's line, in px, positive inside; corners counter-clockwise as seen."""
    margin = np.full(x.shape, np.inf)
    for k in range(3):
        (ax, ay), (bx, by) = corners[k], corners[(k + 1) % 3]
        length = math.hypot(bx - ax, by - ay)
        if length > 0:
            margin = np.minimum(margin, ((by - ay) * (x - ax) - (bx - ax) * (y - ay)) / length)
    return margin


def _reach(corners: Floats, x: Floats, y: Floats) -> Mask:
    """The points inside of a face of either winding or within MOVE of it: no move brings it farther."""
    inside = (_margin(corners, x, y) >= 0) | (_margin(corners[::-1], x, y) >= 0)
    for k in range(3):
        inside |= _distance(corners[[k, (k + 1) % 3]], x, y) <= MOVE
    return np.asarray(inside)


def _near_outline(pieces: list[_Piece], width: int, height: int) -> Mask:
    """The pixels whose centre is within MOVE of an edge that does not join two sure faces, or of a maybe."""
    edges = Counter((piece.keys[k], piece.keys[(k + 1) % 3]) for piece in pieces if piece.sure for k in range(3))
    near = np.zeros((height, width), np.bool_)
    for piece in pieces:
        window = _window(piece.corners, width, height)
        if window is None:
            continue
        if not piece.sure:
            near[window] |= _reach(piece.corners, *_centres(window))
            continue
        for k in range(3):
            a, b = piece.keys[k], piece.keys[(k + 1) % 3]
            if edges[a, b] != edges[b, a]:
                near[window] |= _distance(piece.corners[[k, (k + 1) % 3]], *_centres(window)) <= MOVE
    return near


def _distance(ends: Floats, x: Floats, y: Floats) -> Floats:
    """Distance of the points from a line segment, in px."""
    (ax, ay), (dx, dy) = ends[0], ends[1] - ends[0]
    square = dx * dx + dy * dy
    t = np.clip(((x - ax) * dx + (y - ay) * dy) / square, 0, 1) if square > 0 else np.zeros(x.shape)
    return np.asarray(np.hypot(x - ax - t * dx, y - ay - t * dy))


def _texture_coordinates(piece: _Piece, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """u, v in texels at the centres, and their greatest change under the moves, to first order in MOVE."""
    w = _at(piece.planes["w"], x, y)
    values, changes = [], []
    for name in "uv":
        value = _at(piece.planes[name], x, y) / w
        slopes = [(piece.planes[name][axis] - value * piece.planes["w"][axis]) / w for axis in (1, 2)]
        values.append(value)
        changes.append(MOVE * np.hypot(*slopes))
    return np.stack(values, axis=-1), np.stack(changes, axis=-1)
