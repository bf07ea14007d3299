"""Every dialect of OBJ and MTL is understood, and what a file cannot mean is refused with its line."""

from __future__ import annotations

import numpy as np
import pytest

from converting import soup_from
from edgeline.convert.mesh import quantise
from edgeline.convert.obj import NONE, ObjModel, parse_mtl, parse_obj
from edgeline.convert.texels import Texture
from edgeline.errors import EdgelineError

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def parse(text: str) -> ObjModel:
    return parse_obj("model.obj", text.encode())


def refusal(text: str) -> str:
    with pytest.raises(EdgelineError) as caught:
        parse(text)
    message = str(caught.value)
    assert "\n" not in message
    return message


@pytest.mark.parametrize(
    "text",
    [
        TRIANGLE,
        TRIANGLE.replace("\n", "\r\n"),
        TRIANGLE.rstrip("\n"),
        "\ufeff" + TRIANGLE,
        "# comment\n\n  " + TRIANGLE.replace("f 1 2 3", "f  1\t2 3 # the only one"),
        TRIANGLE.replace("f 1 2 3", "f 1 \\\n 2 \\\n 3"),
        TRIANGLE.replace("f 1 2 3", "f 1 \\\r\n 2 3"),
        TRIANGLE.replace("f 1 2 3", "f -3 -2 -1"),
        "o thing\ng part one\ns off\n" + TRIANGLE + "l 1 2\np 1\ns 1\n",
        TRIANGLE.replace("v 1 0 0", "v 1.0e0 +0 -0.0 1.0"),
        "f 1 2 3\n" + TRIANGLE.replace("f 1 2 3\n", ""),
        "# Gr\u00fc\u00dfe\n" + TRIANGLE,
    ],
)
def test_the_same_triangle_in_every_spelling(text: str) -> None:
    model = parse(text)
    assert model.positions == [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    assert [face.positions for face in model.faces] == [(0, 1, 2)]


def test_latin_1_comments_do_not_matter() -> None:
    assert len(parse_obj("m.obj", b"# Gr\xfc\xdfe\n" + TRIANGLE.encode()).faces) == 1


def test_corners_with_texture_coordinates_and_normals() -> None:
    head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5\nvt 0.5 0.25\nvt 0.5 0.75 0.1\nvn 0 0 1\n"
    model = parse(head + "f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//-1 3//1\nf 1/1/1 2/2/1 3/-1/1\n")
    assert model.uvs == [(0.5, 0.0), (0.5, 0.25), (0.5, 0.75)]
    assert [face.uvs for face in model.faces] == [(NONE,) * 3, (0, 1, 2), (NONE,) * 3, (0, 1, 2)]
    assert [face.normals for face in model.faces] == [(NONE,) * 3, (NONE,) * 3, (0, 0, 0), (0, 0, 0)]
    assert [face.line for face in model.faces] == [8, 9, 10, 11]


def test_vertex_colours() -> None:
    model = parse("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 1 0.5\nf 1 2 3\n")
    soup = soup_from(model, {}, None)
    assert soup.colours is not None
    assert soup.colours.tolist() == [[[255, 128, 0], [255, 255, 255], [0, 0, 255]]]


def test_materials_colour_their_faces() -> None:
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl red one\nf 1 2 3\nusemtl unknown\nf 1 2 3\n"
    materials = parse_mtl("m.mtl", b"newmtl red one\r\nKd 1 0 0.5\r\nmap_Kd -s 2 2 1 -clamp on my wood.png\n")
    assert materials["red one"].image == "my wood.png"
    assert materials["red one"].line == 3
    colours = soup_from(parse(text), materials, None).triangle_colours
    assert colours is not None
    assert colours.tolist() == [[204, 204, 204], [255, 0, 128], [204, 204, 204]]


def test_v_is_turned_down_and_texels_are_counted() -> None:
    text = QUAD + "vt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    mesh = quantise(soup_from(parse(text), {}, Texture(np.zeros((32, 64), np.uint16)))).mesh
    assert mesh.uvs is not None
    at = {tuple(p): tuple(uv) for p, uv in zip(mesh.positions.tolist(), mesh.uvs.tolist(), strict=True)}
    one = 1 << -mesh.scale_log2
    assert at == {
        (0, 0, 0): (0, 32 * 16),
        (one, 0, 0): (128 * 16, 32 * 16),
        (one, one, 0): (128 * 16, 0),
        (0, one, 0): (0, 0),
    }


def test_far_texture_coordinates_move_by_whole_repetitions() -> None:
    text = QUAD + "vt 1000 0\nvt 1002 0\nvt 1002 1\nvt 1000 1\nf 1/1 2/2 3/3 4/4\n"
    soup = soup_from(parse(text), {}, Texture(np.zeros((64, 64), np.uint16)))
    assert soup.uvs is not None
    assert np.ptp(soup.uvs[..., 0]) == 128
    assert not np.any(soup.uvs % 64)
    assert np.abs(soup.uvs).max() <= 128


def test_texture_coordinates_out_of_range_name_the_vertex() -> None:
    text = QUAD + "vt 0 0\nvt 50 0\nvt 50 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    with pytest.raises(EdgelineError, match=r"^model.obj:9: corner \d has texture coordinate .* --texture-size$"):
        soup_from(parse(text), {}, Texture(np.zeros((128, 128), np.uint16)))


def test_missing_texture_coordinates_name_the_face() -> None:
    text = QUAD + "vt 0 0\nf 1/1 2/1 3/1\nf 1 2 3\n"
    with pytest.raises(EdgelineError, match=r"^model.obj:7: a corner without texture coordinates .* --no-texture$"):
        soup_from(parse(text), {}, Texture(np.zeros((8, 8), np.uint16)))


@pytest.mark.parametrize(
    ("text", "start"),
    [
        ("", "model.obj: no face in this file"),
        ("v 1 2 3\n", "model.obj: no face in this file"),
        ("v 0 0\n", "model.obj:1: v needs 3 to 7 numbers and has 2"),
        ("\n\nv 0 0 zero\n", "model.obj:3: 'zero' is no number"),
        ("v 0 nan 0\n", "model.obj:1: 'nan' is no finite number"),
        ("v 0 1e999 0\n", "model.obj:1: '1e999' is no finite number"),
        ("v 1_0 0 0\n", "model.obj:1: '1_0' is no finite number"),
        ("v 0 0 0 1 1\n", "model.obj:1: v with 5 numbers"),
        ("v 0 0 0 255 0 0\n", "model.obj:1: a vertex colour outside 0 to 1"),
        ("vt\n", "model.obj:1: vt needs 1 to 3 numbers and has 0"),
        ("vn 0 1\n", "model.obj:1: vn needs 3 numbers and has 2"),
        (QUAD + "f 1 2\n", "model.obj:5: a face needs 3 corners and has 2"),
        (QUAD + "f 1 2 5\n", "model.obj:5: vertex 5, but the file has 4"),
        (QUAD + "f 1 2 0\n", "model.obj:5: vertex 0, but there are 4 so far"),
        (QUAD + "f 1 2 -5\n", "model.obj:5: vertex -5, but there are 4 so far"),
        (QUAD + "f 1/1 2/1 3/1\n", "model.obj:5: texture coordinate 1, but the file has 0"),
        (QUAD + "f 1//7 2//7 3//7\n", "model.obj:5: normal 7, but the file has 0"),
        (QUAD + "f 1 2 3.5\n", "model.obj:5: '3.5' is no index of a vertex"),
        (QUAD + "f 1 2 99999999999999999999\n", "model.obj:5: '99999999999999999999' is no index"),
        (QUAD + "f 1 2 /3\n", "model.obj:5: '/3' is no corner"),
        (QUAD + "f 1 2 3/1/1/1\n", "model.obj:5: '3/1/1/1' is no corner"),
        (QUAD + "f 1 2 \\\n", "model.obj:5: the file ends in a continued line"),
        ("v 0 0 0\0\n", "model.obj: this is not text"),
    ],
)
def test_refusals_say_what_and_where(text: str, start: str) -> None:
    assert refusal(text).startswith(start)


def test_a_file_cut_anywhere_is_read_or_refused_in_one_line() -> None:
    text = QUAD + "vt 0.25 0.5\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"
    for end in range(len(text)):
        try:
            parse(text[:end])
        except EdgelineError as error:
            assert str(error).startswith("model.obj")
            assert "\n" not in str(error)
