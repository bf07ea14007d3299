"""The container of glTF 2.0: JSON and binary chunk of a .glb, buffers inside and beside a .gltf, accessors as arrays.

Every index, type and range is checked here, so that what reads meshes out of it (`gltf`) can take it at its word.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
import urllib.parse
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from edgeline.convert.source import MOST_TRIANGLES
from edgeline.errors import EdgelineError

KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
GLB_HEADER = struct.Struct("<4sII")
CHUNK_HEADER = struct.Struct("<I4s")
MOST_ELEMENTS = 3 * MOST_TRIANGLES

Json = dict[str, Any]
Kind = TypeVar("Kind")


@dataclass
class GltfFile:
    """`read_beside` gives the bytes of a file that lies beside the model, by its name; it raises EdgelineError."""

    name: str
    json: Json
    chunk: bytes | None
    read_beside: Callable[[str], bytes]
    _buffers: dict[int, bytes] = field(default_factory=dict)

    def error(self, text: str) -> EdgelineError:
        return EdgelineError(f"{self.name}: {text}; export the model again")

    def value(self, owner: Json, where: str, key: str, kind: type[Kind], default: Kind | None = None) -> Kind:
        """A member of an object, of the type that it has to have; `default` where there may be none."""
        found = owner.get(key, default)
        if not isinstance(found, kind) or (isinstance(found, bool) and kind is not bool):
            what = "is missing" if key not in owner else "is of the wrong type"
            raise self.error(f"{where}: '{key}' {what}")
        return found

    def count(self, owner: Json, where: str, key: str, default: int | None = None) -> int:
        """A member that is a whole number, 0 or above."""
        found = self.value(owner, where, key, int, default)
        if found < 0:
            raise self.error(f"{where}: '{key}' is {found}")
        return found

    def numbers(self, owner: Json, where: str, key: str, default: list[float]) -> list[float]:
        """A member that is as many finite numbers as `default`."""
        found = owner.get(key, default)
        good = isinstance(found, list) and len(found) == len(default)
        good = good and all(isinstance(v, (int, float)) and not isinstance(v, bool) and abs(v) < 1e30 for v in found)
        if not good:
            raise self.error(f"{where}: '{key}' has to be {len(default)} finite numbers")
        return [float(v) for v in found]

    def item(self, array: str, index: object, user: str) -> Json:
        """The object number `index` of one of the file's arrays, which `user` names."""
        items = self.json.get(array, [])
        if not isinstance(items, list):
            raise self.error(f"'{array}' is no array")
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(items):
            raise self.error(f"{user} names number {index!r:.40} of {array}, of which there are {len(items)}")
        if not isinstance(items[index], dict):
            raise self.error(f"{array}[{index}] is no object")
        return dict(items[index])

    def resource(self, uri: str, where: str) -> bytes:
        """What a uri holds or names."""
        if uri.startswith("data:"):
            head, comma, body = uri.partition(",")
            if not comma or not head.endswith(";base64"):
                raise self.error(f"{where}: a data uri that is not base64")
            try:
                return base64.b64decode(body, validate=True)
            except (binascii.Error, ValueError):
                raise self.error(f"{where}: its base64 is damaged") from None
        if "://" in uri:
            raise self.error(f"{where}: {uri[:60]!r} is somewhere else; only files beside the model are read")
        try:
            return self.read_beside(urllib.parse.unquote(uri))
        except EdgelineError as error:
            raise EdgelineError(f"{self.name}: {where}: {error}; put it beside the model") from error

    def buffer(self, index: object, user: str) -> bytes:
        buffer = self.item("buffers", index, user)
        assert isinstance(index, int)
        if index not in self._buffers:
            where = f"buffers[{index}]"
            size = self.count(buffer, where, "byteLength")
            if "uri" in buffer:
                data = self.resource(self.value(buffer, where, "uri", str), where)
            elif index == 0 and self.chunk is not None:
                data = self.chunk
            else:
                raise self.error(f"{where}: it has neither a uri nor the file's binary chunk")
            if len(data) < size:
                raise self.error(f"{where}: {len(data)} bytes, but it should have {size}; something is cut short")
            self._buffers[index] = data[:size]
        return self._buffers[index]

    def view(self, index: object, user: str) -> tuple[bytes, int]:
        """The bytes of a buffer view, and its stride, 0 where it has none."""
        view = self.item("bufferViews", index, user)
        where = f"bufferViews[{index}]"
        data = self.buffer(view.get("buffer"), where)
        begin = self.count(view, where, "byteOffset", 0)
        size = self.count(view, where, "byteLength")
        if begin + size > len(data):
            raise self.error(f"{where}: it ends at byte {begin + size} of {len(data)}")
        return data[begin : begin + size], self.count(view, where, "byteStride", 0)

    def _elements(
        self, owner: Json, where: str, kind: np.dtype[Any], width: int, count: int
    ) -> npt.NDArray[np.generic]:
        """`count` rows of `width` numbers out of the view that `owner` names."""
        data, stride = self.view(owner.get("bufferView"), where)
        begin = self.count(owner, where, "byteOffset", 0)
        size = width * kind.itemsize
        stride = stride or size
        if stride < size or (count > 0 and begin + (count - 1) * stride + size > len(data)):
            raise self.error(f"{where}: {count} elements do not fit its buffer view of {len(data)} bytes")
        if count == 0:
            return np.zeros((0, width), kind)
        whole = np.frombuffer(data[begin : begin + (count - 1) * stride + size], np.uint8)
        rows = np.lib.stride_tricks.as_strided(whole, (count, size), (stride, 1))
        return np.asarray(np.ascontiguousarray(rows).view(kind))

    def accessor(self, index: object, user: str, widths: tuple[str, ...]) -> npt.NDArray[np.generic]:
        """An accessor's rows (count, width), normalised ones as fractions. Its type has to be one of `widths`."""
        accessor = self.item("accessors", index, user)
        where = f"accessors[{index}]"
        shape = self.value(accessor, where, "type", str)
        component = self.count(accessor, where, "componentType")
        count = self.count(accessor, where, "count")
        if shape not in widths or component not in KINDS:
            raise self.error(f"{where}: type {shape:.20} of {component}, where {user} needs {' or '.join(widths)}")
        if count > MOST_ELEMENTS:
            raise self.error(f"{where}: {count} elements, {MOST_ELEMENTS} at most are read")
        kind, width = np.dtype(KINDS[component]), WIDTHS[shape]
        if "bufferView" in accessor:
            rows = self._elements(accessor, where, kind, width, count)
        else:
            rows = np.zeros((count, width), kind)
        if "sparse" in accessor:
            rows = self._sparse(self.value(accessor, where, "sparse", dict), f"{where}.sparse", rows)
        if accessor.get("normalized") is True and kind.kind in "iu":
            return np.asarray(np.maximum(rows.astype(np.float64) / np.iinfo(kind).max, -1.0))
        return rows

    def _sparse(self, sparse: Json, where: str, rows: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
        """`rows` with some of them replaced."""
        count = self.count(sparse, where, "count")
        places = self.value(sparse, where, "indices", dict)
        component = self.count(places, where, "componentType")
        if component not in (5121, 5123, 5125) or count > len(rows):
            raise self.error(f"{where}: its indices are of the wrong type, or too many")
        indices = self._elements(places, where, np.dtype(KINDS[component]), 1, count).reshape(-1).astype(np.int64)
        if count > 0 and int(indices.max()) >= len(rows):
            raise self.error(f"{where}: it replaces element {int(indices.max())} of {len(rows)}")
        values = self._elements(self.value(sparse, where, "values", dict), where, rows.dtype, rows.shape[1], count)
        replaced: npt.NDArray[np.generic] = rows.copy()
        replaced[indices] = values
        return replaced


def open_gltf(name: str, data: bytes, read_beside: Callable[[str], bytes]) -> GltfFile:
    """The file, its version and required extensions not looked at yet. Raises EdgelineError."""
    text, chunk = _chunks(name, data) if data[:4] == b"glTF" else (data, None)
    try:
        content = json.loads(text.decode("utf-8-sig"))
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        line = f":{error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        raise EdgelineError(f"{name}{line}: this is no glTF, or a damaged one; export the model again") from None
    if not isinstance(content, dict):
        raise EdgelineError(f"{name}: this is no glTF; export the model again")
    return GltfFile(name, content, chunk, read_beside)


def _chunks(name: str, data: bytes) -> tuple[bytes, bytes | None]:
    """JSON and binary chunk of a .glb."""
    if len(data) < GLB_HEADER.size:
        raise EdgelineError(f"{name}: {len(data)} bytes; the .glb is cut short, export the model again")
    _, version, size = GLB_HEADER.unpack_from(data)
    if version != 2:
        raise EdgelineError(f"{name}: glTF version {version}, this reads version 2; export the model as glTF 2.0")
    if size > len(data):
        raise EdgelineError(f"{name}: {len(data)} of {size} bytes; the .glb is cut short, export the model again")
    chunks: list[tuple[bytes, bytes]] = []
    at = GLB_HEADER.size
    while at + CHUNK_HEADER.size <= size and len(chunks) < 2:
        length, kind = CHUNK_HEADER.unpack_from(data, at)
        at += CHUNK_HEADER.size
        if at + length > size:
            raise EdgelineError(f"{name}: a chunk of the .glb ends beyond the file; export the model again")
        chunks.append((kind, data[at : at + length]))
        at += length
    if not chunks or chunks[0][0] != b"JSON":
        raise EdgelineError(f"{name}: the .glb does not begin with JSON; export the model again")
    return chunks[0][1], chunks[1][1] if len(chunks) > 1 and chunks[1][0] == b"BIN\0" else None
