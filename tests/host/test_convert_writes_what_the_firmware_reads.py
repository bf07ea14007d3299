"""The .elm and the C header of a mesh hold the same, and the firmware's own reader and a C compiler agree."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
import zlib
from pathlib import Path

import numpy as np
import pytest

from edgeline.convert import elm
from edgeline.convert.clusters import in_order
from edgeline.convert.header import NamedMesh, c_header
from edgeline.convert.mesh import Mesh, Texture
from edgeline.errors import EdgelineError

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "firmware" / "src"


def some_mesh(seed: int) -> tuple[Mesh, Texture | None]:
    """A mesh of random numbers with a random selection of everything optional."""
    numbers = np.random.default_rng(seed)
    n, m = int(numbers.integers(3, 40)), int(numbers.integers(1, 60))
    has = numbers.integers(0, 2, size=6).astype(bool)
    texture = None
    if has[4]:
        height, width = (1 << int(log2) for log2 in numbers.integers(0, 6, size=2))
        texture = Texture(numbers.integers(0, 65536, size=(height, width)).astype(np.uint16))
    mesh = Mesh(
        positions=numbers.integers(-32768, 32768, size=(n, 3)).astype(np.int16),
        triangles=numbers.integers(0, n, size=(m, 3)).astype(np.uint16),
        scale_log2=int(numbers.integers(-30, 9)),
        colours=numbers.integers(0, 256, size=(n, 3)).astype(np.uint8) if has[0] else None,
        triangle_colours=numbers.integers(0, 256, size=(m, 3)).astype(np.uint8) if has[1] else None,
        normals=numbers.integers(-127, 128, size=(n, 3)).astype(np.int8) if has[2] else None,
        uvs=numbers.integers(-32768, 32768, size=(n, 2)).astype(np.int16) if has[3] or has[4] else None,
    )
    return in_order(mesh, 7) if has[5] else mesh, texture


def same(a: object, b: object) -> bool:
    """Whether two meshes or textures hold the same, arrays included."""
    for key, value in vars(a).items():
        other = vars(b)[key]
        if isinstance(value, np.ndarray):
            if not (isinstance(other, np.ndarray) and value.dtype == other.dtype and np.array_equal(value, other)):
                return False
        elif value != other:
            return False
    return True


@pytest.mark.parametrize("seed", range(60))
def test_an_elm_gives_back_what_was_written(seed: int) -> None:
    mesh, texture = some_mesh(seed)
    data = elm.encode(mesh, texture)
    assert len(data) % 4 == 0
    read_mesh, read_texture = elm.decode(data)
    assert same(mesh, read_mesh)
    assert (texture is None) == (read_texture is None)
    assert texture is None or same(texture, read_texture)
    assert elm.encode(read_mesh, read_texture) == data


def test_an_elm_cut_at_any_length_is_refused() -> None:
    data = elm.encode(*some_mesh(1))
    for end in range(len(data)):
        with pytest.raises(EdgelineError, match="not an .elm" if end < 4 else "cut short"):
            elm.decode(data[:end])
    with pytest.raises(EdgelineError, match="damaged"):
        elm.decode(data + b"\0\0\0\0")


def test_an_elm_with_any_bit_wrong_is_refused() -> None:
    data = elm.encode(*some_mesh(2))
    for at in [*range(6), *range(8, len(data))]:  # 6 and 7 are the minor version
        for bit in range(8):
            wrong = bytearray(data)
            wrong[at] ^= 1 << bit
            with pytest.raises(EdgelineError):
                elm.decode(bytes(wrong))


def test_an_elm_of_a_newer_version_says_so() -> None:
    data = bytearray(elm.encode(*some_mesh(3)))
    data[6] = 9
    elm.decode(bytes(data))
    data[4] = 2
    with pytest.raises(EdgelineError, match=r"has version 2.9, this Edgeline reads 1.x; update Edgeline"):
        elm.decode(bytes(data))


@pytest.mark.parametrize(
    ("at", "value"), [("<H16", 0), ("<H18", 0), ("<b20", 9), ("<b20", -31), ("<B21", 32), ("<B22", 11), ("<H30", 1)]
)
def test_a_faulty_writer_is_found_under_a_right_crc(at: str, value: int) -> None:
    data = bytearray(elm.encode(*some_mesh(4)))
    struct.pack_into(at[:2], data, int(at[2:]), value)
    struct.pack_into("<I", data, 12, zlib.crc32(data[16:]))
    with pytest.raises(EdgelineError):
        elm.decode(bytes(data))


def test_a_texture_needs_texture_coordinates() -> None:
    mesh = Mesh(np.eye(3, dtype=np.int16), np.array([[0, 1, 2]], np.uint16), 0)
    with pytest.raises(EdgelineError, match="needs texture coordinates"):
        elm.encode(mesh, Texture(np.zeros((2, 2), np.uint16)))


PROGRAM = r"""
#include <stdio.h>
#include <string.h>
#include "geometry/elm.h"
#include "mesh.h"

static int same(const void *a, const void *b, size_t bytes)
{
    return (a == NULL) == (b == NULL) && (a == NULL || memcmp(a, b, bytes) == 0);
}

int main(int count, char **arguments)
{
    static uint32_t bytes[65536];
    FILE *file = fopen(arguments[count - 1], "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    el_mesh m;
    el_texture t;
    const el_elm_status status = el_elm_open(bytes, size, &m, &t);
    if (status != EL_ELM_OK) {
        printf("%s\n", el_elm_message(status));
        return 1;
    }
    const size_t n = m.vertex_count, k = m.triangle_count;
    const int equal = n == mesh.vertex_count && k == mesh.triangle_count && m.scale_log2 == mesh.scale_log2 &&
                      m.radius == mesh.radius && same(m.centre, mesh.centre, 6) &&
                      same(m.positions, mesh.positions, 6 * n) && same(m.triangles, mesh.triangles, 6 * k) &&
                      same(m.colours, mesh.colours, 3 * n) &&
                      same(m.triangle_colours, mesh.triangle_colours, 3 * k) &&
                      same(m.normals, mesh.normals, 3 * n) && same(m.uvs, mesh.uvs, 4 * n);
#ifdef TEXTURE
    const el_texture *h = &mesh_texture;
    const int equal_texture = t.width_log2 == h->width_log2 && t.height_log2 == h->height_log2 &&
                              same(t.texels, h->texels, (size_t)2 << (t.width_log2 + t.height_log2));
#else
    const int equal_texture = t.texels == NULL;
#endif
    printf("%s %s\n", equal ? "same mesh" : "another mesh", equal_texture ? "same texture" : "another texture");
    return !(equal && equal_texture);
}
"""


@pytest.mark.parametrize("seed", range(6))
def test_the_firmware_reads_the_elm_and_finds_the_header_in_it(seed: int, tmp_path: Path) -> None:
    compiler = shutil.which("cc")
    if compiler is None:
        assert "CI" not in os.environ, "no C compiler"
        pytest.skip("no C compiler")
    mesh, texture = some_mesh(100 + seed)
    (tmp_path / "mesh.elm").write_bytes(elm.encode(mesh, texture))
    (tmp_path / "mesh.h").write_text(c_header("mesh", ["A test."], [NamedMesh("mesh", mesh, texture)]))
    (tmp_path / "edgeline.h").write_text('#include "geometry/mesh.h"\n')
    (tmp_path / "main.c").write_text(PROGRAM)
    flags = ["-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", f"-I{tmp_path}", f"-I{SOURCE}"]
    flags += ["-DTEXTURE"] if texture is not None else []
    sources = [tmp_path / "main.c", SOURCE / "geometry" / "elm.c", SOURCE / "base" / "crc32.c"]
    subprocess.run([compiler, *flags, *map(str, sources), "-o", str(tmp_path / "check")], check=True)
    ran = subprocess.run([tmp_path / "check", tmp_path / "mesh.elm"], capture_output=True, text=True, check=False)
    assert ran.stdout == "same mesh same texture\n"


def test_headers_keep_to_120_columns_and_name_no_date_or_folder() -> None:
    mesh, texture = some_mesh(101)
    text = c_header(
        "mesh", ["A test.", "Made by: edgeline convert a.obj */ int x;"], [NamedMesh("mesh", mesh, texture)]
    )
    assert max(map(len, text.splitlines())) <= 120
    assert text.count("*/ ") == 0
    assert text == c_header(
        "mesh", ["A test.", "Made by: edgeline convert a.obj */ int x;"], [NamedMesh("mesh", mesh, texture)]
    )
