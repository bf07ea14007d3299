"""The .elm and the C header of a mesh hold the same, and the firmware's own reader and a C compiler agree."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from edgeline.convert import elm
from edgeline.convert.clusters import in_order
from edgeline.convert.header import Look, NamedMesh, c_header
from edgeline.convert.mesh import Mesh
from edgeline.convert.texels import Format, Texture, Wrap, linked
from edgeline.errors import EdgelineError

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "firmware" / "src"
FIRMWARE = ("geometry/elm.c", "geometry/elm_surface.c", "base/crc32.c", "raster/texture.c")


Made = tuple[Mesh, Texture | None]


def some_texture(numbers: np.random.Generator) -> Texture:
    """Of random format, sides and texels, with a random selection of everything optional."""
    form = Format(int(numbers.integers(0, 4)))
    sides_log2 = numbers.integers(0, 6, size=2)
    palette = numbers.integers(0, 65536, size=form.colours).astype(np.uint16)
    has_alpha, has_key, smooth = numbers.integers(0, 2, size=3).astype(bool)
    key = int(numbers.integers(1, 1 << form.bits)) if has_key else None
    wrap = Wrap(int(numbers.integers(0, 3))), Wrap(int(numbers.integers(0, 3)))
    levels = []
    for level in range(int(numbers.integers(1, int(max(sides_log2)) + 2))):
        width, height = (1 << max(0, int(log2) - level) for log2 in sides_log2)
        texels = numbers.integers(0, 1 << form.bits, size=(height, width)).astype(np.uint16)
        alpha = numbers.integers(0, 256, size=(height, width)).astype(np.uint8) if has_alpha else None
        levels.append(Texture(texels, form, palette, alpha, key, wrap, bool(smooth)))
    return linked(levels)


def some_surface(seed: int) -> tuple[Mesh, Texture | None, Look]:
    """The same with a texture of any kind and a material, or no texture at all."""
    numbers = np.random.default_rng(1000 + seed)
    mesh, _ = some_mesh(seed)
    texture = some_texture(numbers) if mesh.uvs is not None else None
    return mesh, texture, Look(bool(numbers.integers(0, 2)), int(numbers.integers(1, 256)))


def some_mesh(seed: int) -> Made:
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
        elif isinstance(value, Texture) and isinstance(other, Texture):
            if not same(value, other):
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


@pytest.mark.parametrize("seed", range(100))
def test_an_elm_with_a_surface_gives_it_back(seed: int) -> None:
    mesh, texture, look = some_surface(seed)
    data = elm.encode(mesh, texture, look)
    assert data[4] == 2
    read_mesh, read_texture, read_look = elm.decode_all(data)
    assert same(mesh, read_mesh) and look == read_look
    assert (texture is None) == (read_texture is None)
    assert texture is None or (read_texture is not None and same(texture, read_texture))
    assert elm.encode(read_mesh, read_texture, read_look) == data


def test_what_the_first_version_holds_is_written_as_that() -> None:
    mesh, texture = next(made for made in map(some_mesh, range(99)) if made[1] is not None)
    assert texture is not None
    plain = elm.encode(mesh, texture, Look())
    assert plain == elm.encode(mesh, texture) and plain[4] == 1
    for other in (replace(texture, smooth=True), replace(texture, wrap=(Wrap.CLAMP, Wrap.REPEAT))):
        assert elm.encode(mesh, other, Look())[4] == 2
    assert elm.encode(mesh, texture, Look(two_sided=True))[4] == elm.encode(mesh, None, Look(opacity=9))[4] == 2


@pytest.mark.parametrize("made", [some_mesh(1), some_surface(1)])
def test_an_elm_cut_at_any_length_is_refused(made: Made) -> None:
    data = elm.encode(*made)
    for end in range(len(data)):
        with pytest.raises(EdgelineError, match="not an .elm" if end < 4 else "cut short"):
            elm.decode(data[:end])
    with pytest.raises(EdgelineError, match="damaged"):
        elm.decode(data + b"\0\0\0\0")


@pytest.mark.parametrize("made", [some_mesh(2), some_surface(2)])
def test_an_elm_with_any_bit_wrong_is_refused(made: Made) -> None:
    data = elm.encode(*made)
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
    data[4] = 3
    with pytest.raises(EdgelineError, match=r"has version 3.9, this Edgeline reads 1.x and 2.x; update Edgeline"):
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
#include "raster/texture.h"
#include "mesh.h"

static int same(const void *a, const void *b, size_t bytes)
{
    return (a == NULL) == (b == NULL) && (a == NULL || memcmp(a, b, bytes) == 0);
}

#ifdef TEXTURE
static size_t row_bytes(const el_image *i)
{
    static const size_t bits[] = {16, 8, 4, 1};
    return (i->width * bits[i->format] + 7) / 8;
}

static int same_image(const el_image *a, const el_image *b)
{
    static const size_t colours[] = {0, 256, 16, 1};
    return a->width == b->width && a->height == b->height && a->format == b->format && a->has_key == b->has_key &&
           a->key == b->key && same(a->pixels, b->pixels, row_bytes(a) * a->height) &&
           (a->format == 0 || same(a->palette, b->palette, 2 * colours[a->format])) &&
           same(a->alpha, b->alpha, (size_t)a->width * a->height);
}

static int same_texture(const el_texture *a, const el_texture *b)
{
    for (; a != NULL && b != NULL; a = a->smaller, b = b->smaller) {
        if (a->wrap_u != b->wrap_u || a->wrap_v != b->wrap_v || a->smooth != b->smooth ||
            (a->image == NULL) != (b->image == NULL)) {
            return 0;
        }
        if (a->image != NULL ? !same_image(a->image, b->image)
                             : a->width_log2 != b->width_log2 || a->height_log2 != b->height_log2 ||
                                   !same(a->texels, b->texels, (size_t)2 << (a->width_log2 + a->height_log2))) {
            return 0;
        }
    }
    return a == b && el_texture_is_good(&mesh_texture);
}
#endif

int main(int count, char **arguments)
{
    static uint32_t bytes[65536];
    FILE *file = fopen(arguments[count - 1], "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    el_mesh m;
    static el_elm_surface s;
    const el_elm_status status = el_elm_open_surface(bytes, size, &m, &s);
    el_texture plain;
    const el_elm_status first = el_elm_open(bytes, size, &m, &plain);
    if (status != EL_ELM_OK || first != (((const uint8_t *)bytes)[4] == 1 ? EL_ELM_OK : EL_ELM_VERSION)) {
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
    const int equal_look = s.flags == mesh_material.flags &&
                           s.alpha == (mesh_material.alpha == 0 ? 255 : mesh_material.alpha);
#ifdef TEXTURE
    const int equal_texture = same_texture(&s.levels[0], &mesh_texture) && mesh_material.texture == &mesh_texture;
#else
    const int equal_texture = s.levels[0].texels == NULL && s.levels[0].image == NULL;
#endif
    printf("%s %s %s\n", equal ? "same mesh" : "another mesh", equal_texture ? "same texture" : "another texture",
           equal_look ? "same look" : "another look");
    return 0;
}
"""


@pytest.mark.parametrize("seed", range(16))
def test_the_firmware_reads_the_elm_and_finds_the_header_in_it(seed: int, tmp_path: Path) -> None:
    compiler = shutil.which("cc")
    if compiler is None:
        assert "CI" not in os.environ, "no C compiler"
        pytest.skip("no C compiler")
    mesh, texture, look = (*some_mesh(100 + seed), Look()) if seed < 4 else some_surface(100 + seed)
    (tmp_path / "mesh.elm").write_bytes(elm.encode(mesh, texture, look))
    (tmp_path / "mesh.h").write_text(c_header("mesh", ["A test."], [NamedMesh("mesh", mesh, texture, material=look)]))
    (tmp_path / "main.c").write_text(PROGRAM)
    flags = ["-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", f"-I{tmp_path}", f"-I{SOURCE}"]
    flags += ["-DTEXTURE"] if texture is not None else []
    sources = [tmp_path / "main.c", *(SOURCE / name for name in FIRMWARE)]
    subprocess.run([compiler, *flags, *map(str, sources), "-o", str(tmp_path / "check")], check=True)
    ran = subprocess.run([tmp_path / "check", tmp_path / "mesh.elm"], capture_output=True, text=True, check=False)
    assert ran.stdout == "same mesh same texture same look\n"


@pytest.mark.parametrize("seed", range(8))
def test_cpp_takes_the_header_too(seed: int, tmp_path: Path) -> None:
    """As Arduino's sketches include it."""
    compiler = shutil.which("c++")
    if compiler is None:
        assert "CI" not in os.environ, "no C++ compiler"
        pytest.skip("no C++ compiler")
    mesh, texture, look = some_surface(200 + seed)
    text = c_header("mesh", ["A test."], [NamedMesh("mesh", mesh, texture, material=look)])
    text = text.replace('"edgeline.h"', '"raster/material.h"')
    (tmp_path / "mesh.cpp").write_text(f"{text}\nconst el_material *material(void) {{ return &mesh_material; }}\n")
    flags = ["-std=c++20", "-Wall", "-Wconversion", "-Werror", "-fsyntax-only", f"-I{SOURCE}"]
    subprocess.run([compiler, *flags, str(tmp_path / "mesh.cpp")], check=True)


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
