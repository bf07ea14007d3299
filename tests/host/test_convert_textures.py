"""Textures of every format hold what the image shows, and the simulator draws exactly that.

An .elm's texels are those of the C header (test_convert_writes_what_the_firmware_reads.py), so drawing one shows both.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from conftest import Edgeline
from converting import convert, refused
from edgeline.colour import to_rgb
from edgeline.convert import elm
from edgeline.convert.palette import DITHERS, all_of_rgb565, chosen_values, palette_of, rgb565, those_of
from edgeline.convert.texels import Format, Texture, Wrap
from edgeline.convert.texture import Alpha, Pixels, Style, decoded, encoded, halved, textured
from models import Gltf, checks, ring

SIDE = 16
Picture = npt.NDArray[np.uint16]
Bytes = npt.NDArray[np.uint8]


def noise(seed: int, *shape: int) -> Bytes:
    return np.random.default_rng(seed).integers(16, 256, shape).astype(np.uint8)


def smooth_picture(side: int = SIDE) -> Bytes:
    """Slopes in each channel, as photographs have them."""
    y, x = np.mgrid[0:side, 0:side] * (255 // (side - 1))
    return np.stack([x, y, 255 - (x + y) // 2], axis=2).astype(np.uint8)


def square(folder: Path, uvs: tuple[float, float] = (0.0, 1.0), materials: str = "map_Kd image.png") -> Path:
    """A square from -1 to 1 that faces z, its texture coordinates from one number to the other in both directions."""
    low, high = uvs
    (folder / "m.obj").write_text(
        "mtllib m.mtl\nusemtl paint\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
        f"vt {low} {low}\nvt {high} {low}\nvt {high} {high}\nvt {low} {high}\nf 1/1 2/2 3/3 4/4\n"
    )
    (folder / "m.mtl").write_text(f"newmtl paint\n{materials}\n")
    return folder / "m.obj"


def drawn(simulator: str, path: Path, side: int, eye: str = "0,0,1") -> Picture:
    """What the simulator shows of the square, which fills the picture if nothing else is said."""
    raw = path.with_suffix(".raw")
    words = [simulator, "render", "--mesh", path, "--size", f"{side}x{side}", "--raw", raw]
    subprocess.run([*words, f"--eye={eye}", "--look-at", "0,0,0", "--fov", "90"], check=True)
    return np.fromfile(raw, "<u2").reshape(side, side)


def converted(model: Path, *options: object) -> tuple[Path, Texture]:
    output = model.with_suffix(".elm")
    assert convert(model, "-o", output, "--texture-size", 1024, *options) == 0
    texture = elm.decode(output.read_bytes())[1]
    assert texture is not None
    return output, texture


# --- As drawn ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dither", DITHERS)
@pytest.mark.parametrize("form", Format)
def test_every_texel_is_drawn_as_it_is(simulator: str, tmp_path: Path, form: Format, dither: str) -> None:
    Image.fromarray(smooth_picture()).save(tmp_path / "image.png")
    output, texture = converted(square(tmp_path), "--texture-format", form.option, "--dither", dither)
    made = textured(Pixels(smooth_picture()), Style(form, dither))
    assert np.array_equal(texture.texels, made.texels) and np.array_equal(texture.palette, made.palette)
    shown = to_rgb(drawn(simulator, output, 4 * SIDE))[2::4, 2::4]
    assert np.array_equal(shown, np.where(texture.shown()[..., None], texture.colours(), 0))
    assert len(np.unique(texture.texels)) > (1 if form == Format.MASK else 4)


@pytest.mark.parametrize("form", [Format.RGB565, Format.INDEX8, Format.INDEX4])
def test_clear_texels_are_not_drawn(simulator: str, tmp_path: Path, form: Format) -> None:
    rgb = smooth_picture()
    rgb[3, 4] = 255, 0, 255  # what stands for clear texels in RGB565
    alpha = np.where(noise(1, SIDE, SIDE) < 128, 0, 255).astype(np.uint8)
    alpha[3, 4] = 255
    Image.fromarray(np.dstack([rgb, alpha])).save(tmp_path / "image.png")
    output, texture = converted(square(tmp_path), "--texture-format", form.option, "--alpha", "test")
    assert np.array_equal(texture.shown(), alpha == 255)
    shown = drawn(simulator, output, 4 * SIDE)[2::4, 2::4]
    assert np.array_equal(shown != 0, alpha == 255)
    assert np.array_equal(to_rgb(shown)[alpha == 255], texture.colours()[alpha == 255])
    # Clear places have no say in the palette.
    other = rgb.copy()
    other[alpha == 0] = noise(2, int((alpha == 0).sum()), 3)
    again = textured(Pixels(other, alpha, True), Style(form, alpha=Alpha.TEST))
    assert np.array_equal(again.texels, texture.texels) and np.array_equal(again.palette, texture.palette)


def test_alpha_is_mixed(simulator: str, tmp_path: Path) -> None:
    alpha = np.repeat(np.linspace(0, 255, SIDE).astype(np.uint8)[None], SIDE, axis=0)
    Image.fromarray(np.dstack([np.full((SIDE, SIDE, 3), 255, np.uint8), alpha])).save(tmp_path / "image.png")
    output, texture = converted(square(tmp_path), "--alpha", "blend")
    assert texture.alpha is not None and np.array_equal(texture.alpha, alpha)
    red = (drawn(simulator, output, 4 * SIDE)[2::4, 2::4] >> 11).astype(int)
    assert np.abs(red - np.rint(alpha / 255 * 31)).max() <= 1
    assert red[0, 0] == 0 and red[0, -1] == 31


def beyond(index: npt.NDArray[np.int64], wrap: Wrap) -> npt.NDArray[np.int64]:
    """Which texel of SIDE is drawn there."""
    if wrap == Wrap.CLAMP:
        return np.clip(index, 0, SIDE - 1)
    if wrap == Wrap.MIRROR:
        return np.where(index % (2 * SIDE) < SIDE, index % SIDE, SIDE - 1 - index % SIDE)
    return index % SIDE


@pytest.mark.parametrize("wrap", Wrap)
def test_borders_go_on_as_asked(simulator: str, tmp_path: Path, wrap: Wrap) -> None:
    rgb = noise(3, SIDE, SIDE, 3)
    Image.fromarray(rgb).save(tmp_path / "image.png")
    output, texture = converted(square(tmp_path, (-1, 2)), "--wrap", wrap.name.lower())
    assert texture.wrap == (wrap, wrap)
    # Each texel is 4 pixels wide. The first column is that of one repetition before the image; rows run down.
    places = np.arange(3 * SIDE, dtype=np.int64) - SIDE
    across, down = beyond(places, wrap), beyond(places, wrap)
    assert np.array_equal(drawn(simulator, output, 12 * SIDE)[2::4, 2::4], rgb565(rgb)[down[:, None], across])


@pytest.mark.parametrize("wrap", ["clamp", "mirror"])
def test_borders_that_are_not_left_cost_nothing(simulator: str, tmp_path: Path, wrap: str) -> None:
    """All of the image and no more is drawn by the fast loops that repeat, and none of its other side shows."""
    rgb = np.zeros((2, 2, 3), np.uint8)
    rgb[:, 0] = 255, 0, 0
    rgb[:, 1] = 0, 0, 255
    Image.fromarray(rgb).save(tmp_path / "image.png")
    output, texture = converted(square(tmp_path), "--wrap", wrap)
    assert texture.is_plain
    uvs = elm.decode(output.read_bytes())[0].uvs
    assert uvs is not None and (uvs.min(), uvs.max()) == (2, 2 * 16 - 2)  # an eighth of a texel from the borders
    for eye in ("0,0,1.3", "-1.2,0,0.6", "1.2,0.1,0.5", "1.4,0.2,0.3"):
        shown = drawn(simulator, output, 400, eye)
        lines = ("".join({0xF800: "r", 0x001F: "b"}.get(pixel, " ") for pixel in row).strip() for row in shown.tolist())
        assert all(re.fullmatch("r*b*", line) for line in lines)
    assert converted(square(tmp_path), "--wrap", wrap, "--filter", "bilinear")[1].wrap != (Wrap.REPEAT, Wrap.REPEAT)


@pytest.mark.parametrize("form", [Format.RGB565, Format.INDEX8, Format.MASK])
def test_what_is_small_is_drawn_with_smaller_texels(simulator: str, tmp_path: Path, form: Format) -> None:
    Image.fromarray(smooth_picture()).save(tmp_path / "image.png")
    output, texture = converted(square(tmp_path), "--mipmaps", "--texture-format", form.option)
    levels = [*texture.levels()]
    assert [level.texels.shape for level in levels] == [(16, 16), (8, 8), (4, 4), (2, 2), (1, 1)]
    for number in (1, 2):
        level = levels[number]
        shown = to_rgb(drawn(simulator, output, SIDE >> number))
        assert np.array_equal(shown, np.where(level.shown()[..., None], level.colours(), 0))


# --- Colours ----------------------------------------------------------------------------------------------------------


def diffused_one_by_one(
    rgb: Bytes, nearest: Callable[[npt.NDArray[np.int64]], int], seen: npt.NDArray[np.int64]
) -> Picture:
    """Floyd and Steinberg as textbooks have it, pixel by pixel."""
    height, width, _ = rgb.shape
    wanted = rgb.astype(np.int64) << 8
    values = np.zeros((height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            here = np.clip(wanted[y, x], 0, 255 << 8)
            values[y, x] = nearest((here + 128) >> 8)
            error = here - (seen[values[y, x]] << 8)
            shares = [error * 7 >> 4, error * 3 >> 4, error * 5 >> 4]
            shares.append(error - sum(shares))
            for (dy, dx), share in zip(((0, 1), (1, -1), (1, 0), (1, 1)), shares, strict=True):
                if y + dy < height and 0 <= x + dx < width:
                    wanted[y + dy, x + dx] += share
    return values


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (9, 1), (8, 16), (17, 5)])
def test_diffusion_is_that_of_the_textbook(shape: tuple[int, int]) -> None:
    rgb = noise(4, *shape, 3)
    everything = np.ones(shape, bool)
    for colours in (all_of_rgb565(), those_of(np.array([0x0000, 0x8410, 0xF81F, 0x07E0, 0xFFFF], np.uint16))):

        def nearest(colour: npt.NDArray[np.int64], find: Callable[..., npt.NDArray[np.int64]] = colours.nearest) -> int:
            return int(find(colour[None])[0])

        found = chosen_values(rgb, colours, "floyd-steinberg", everything)
        assert np.array_equal(found, diffused_one_by_one(rgb, nearest, colours.seen))


@pytest.mark.parametrize("dither", ["ordered", "floyd-steinberg"])
def test_dithering_keeps_the_mean(dither: str) -> None:
    """Of a colour between those that there are: by far nearer than without."""
    rgb = np.broadcast_to(np.array([100, 131, 37], np.uint8), (64, 64, 3))
    everything = np.ones((64, 64), bool)
    for colours in (all_of_rgb565(), those_of(np.array([0x0000, 0x8400, 0x87F0, 0xFFFF], np.uint16))):
        means = [
            np.abs(colours.seen[chosen_values(rgb, colours, d, everything)].mean(axis=(0, 1)) - rgb[0, 0]).max()
            for d in (dither, "none")
        ]
        assert means[0] < means[1] / 2


def test_few_colours_are_kept_as_they_are() -> None:
    own = rgb565(noise(5, 200, 3))
    rgb = to_rgb(np.random.default_rng(6).choice(own, (32, 32)))
    assert np.array_equal(palette_of(rgb.reshape(-1, 3), 256), np.unique(rgb565(rgb)))
    texture = textured(Pixels(rgb), Style(Format.INDEX8, "floyd-steinberg"))
    assert np.array_equal(texture.colours(), rgb)


def test_the_nearest_of_a_palette_is_found() -> None:
    palette = palette_of(noise(7, 4000, 3), 16)
    assert 8 <= len(palette) <= 16
    rgb = noise(8, 500, 3).astype(np.int64)
    apart = (rgb[:, None] - to_rgb(palette)[None].astype(np.int64)) ** 2
    assert np.array_equal(those_of(palette).nearest(rgb), apart.sum(axis=2).argmin(axis=1))


def test_smaller_levels_are_means_of_light() -> None:
    rgb = noise(9, 8, 16, 3)
    alpha = noise(10, 8, 16) // 2 * 2
    alpha[:2, :2] = 0
    for pixels in (Pixels(rgb), Pixels(rgb, alpha, True)):
        weight = np.ones((8, 16)) if pixels.alpha is None else alpha / 255
        small = halved(pixels)
        for y in range(4):
            for x in range(8):
                here = np.s_[2 * y : 2 * y + 2, 2 * x : 2 * x + 2]
                light, weights = decoded(rgb[here] / 255).reshape(4, 3), weight[here].reshape(4)
                mean = (
                    light.mean(axis=0) if not weights.any() else (light * weights[:, None]).sum(axis=0) / weights.sum()
                )
                assert np.abs(small.rgb[y, x] - encoded(mean) * 255).max() < 0.51
                assert small.alpha is None or abs(int(small.alpha[y, x]) - weights.mean() * 255) <= 0.501
    assert halved(Pixels(rgb[:1])).rgb.shape == (1, 8, 3)
    assert np.array_equal(halved(Pixels(np.full((2, 2, 3), 77, np.uint8))).rgb, [[[77, 77, 77]]])


def test_a_mask_shows_what_is_opaque_or_bright() -> None:
    rgb = smooth_picture()
    alpha = noise(11, SIDE, SIDE)
    clear = textured(Pixels(rgb, alpha, True), Style(Format.MASK))
    assert np.array_equal(clear.shown(), alpha >= 128)
    bright = textured(Pixels(rgb), Style(Format.MASK))
    assert np.array_equal(bright.shown(), (rgb.astype(int) @ [299, 587, 114] + 500) // 1000 >= 128)
    assert int(clear.palette[0]) != int(bright.palette[0])


# --- What a file says -------------------------------------------------------------------------------------------------


def glb(folder: Path, **sampler: object) -> Path:
    gltf = Gltf()
    view = gltf.view(checks())
    more = {key: sampler.pop(key) for key in ("alphaMode", "alphaCutoff", "doubleSided") if key in sampler}
    paint = gltf.material([1, 1, 1, 0.5], {"bufferView": view, "mimeType": "image/png"}, **more)
    gltf.json["samplers"] = [sampler]
    gltf.json["textures"][0]["sampler"] = 0
    gltf.node(gltf.primitive(ring(6, 4), attributes="pt", material=paint))
    (folder / "m.glb").write_bytes(gltf.glb())
    return folder / "m.glb"


def test_samplers_of_gltf(tmp_path: Path) -> None:
    model = glb(tmp_path, wrapS=33648, wrapT=33071, magFilter=9729)
    assert converted(model)[1].wrap == (Wrap.MIRROR, Wrap.REPEAT)  # v stays within the image
    assert not converted(model)[1].smooth
    texture = converted(model, "--filter", "file")[1]
    assert texture.smooth and texture.wrap == (Wrap.MIRROR, Wrap.CLAMP)
    assert converted(model, "--wrap", "repeat")[1].is_plain
    assert "its sampler wraps by 1 and 10497" in refused("convert", glb(tmp_path, wrapS=1), "-o", tmp_path / "m.h")
    told = refused("convert", glb(tmp_path, alphaMode="CLEAR"), "-o", tmp_path / "m.h")
    assert "m.glb: materials[0]: 'alphaMode' is CLEAR" in told


def test_materials_of_gltf_in_the_header(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    convert(glb(tmp_path, alphaMode="BLEND", doubleSided=True), "-o", tmp_path / "m.h")
    assert "note: paint 0: it is blended; draw it after all that is opaque" in capsys.readouterr().out
    text = (tmp_path / "m.h").read_text()
    assert "    .flags = EL_MATERIAL_TWO_SIDED,\n    .colour = {255, 255, 255},\n    .alpha = 128,\n" in text
    assert "    .texture = &m_texture,\n" in text
    convert(glb(tmp_path), "-o", tmp_path / "m.h")
    text = (tmp_path / "m.h").read_text()
    assert ".flags" not in text and ".alpha" not in text and ".image" not in text and ".wrap" not in text


def test_what_a_file_says_in_vain_is_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gltf = Gltf()
    paint = gltf.material([1, 0, 0, 1], emissiveFactor=[0, 0.5, 0])
    gltf.node(gltf.primitive(ring(6, 4), attributes="p", material=paint))
    gltf.json["extensionsUsed"] = ["KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"]
    (tmp_path / "m.glb").write_bytes(gltf.glb())
    convert(tmp_path / "m.glb", "-o", tmp_path / "m.h")
    notes = [line for line in capsys.readouterr().out.splitlines() if "note:" in line]
    assert notes == [
        "  note: paint 0: its glow is left out; el_lighting.emissive makes surfaces glow",
        "  note: what KHR_materials_pbrSpecularGlossiness says is left out",
    ]
    for glow, told in (("0 0 0", False), ("0 0 1", True)):
        square(tmp_path, (0, 2), f"Ke {glow}")
        convert(tmp_path / "m.obj", "-o", tmp_path / "m.h", "--no-texture")
        assert (
            "note: paint: its glow is left out; el_lighting.emissive makes surfaces glow" in capsys.readouterr().out
        ) == told


def test_options_of_textures_that_do_nothing_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = glb(tmp_path)
    convert(model, "-o", tmp_path / "m.h", "--no-texture", "--texture-format", "palette4", "--mipmaps", "--up", "z")
    assert "note: there is no texture, so nothing comes of --texture-format, --mipmaps\n" in capsys.readouterr().out
    convert(model, "-o", tmp_path / "m.h", "--texture-format", "palette4", "--mipmaps")
    convert(model, "-o", tmp_path / "m.h", "--no-texture", "--up", "z")
    assert "nothing comes of" not in capsys.readouterr().out


def test_materials_of_mtl(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    alpha = np.full((SIDE, SIDE), 200, np.uint8)
    Image.fromarray(np.dstack([smooth_picture(), alpha])).save(tmp_path / "image.png")
    square(tmp_path, (0, 2), "d 0.25\nmap_Kd -clamp on image.png\nmap_d image.png")
    output, texture = converted(tmp_path / "m.obj")
    assert texture.wrap == (Wrap.CLAMP, Wrap.CLAMP)
    assert texture.alpha is not None and set(texture.alpha.reshape(-1).tolist()) == {200}
    assert elm.decode_all(output.read_bytes())[2].opacity == 64
    capsys.readouterr()
    square(tmp_path, (0, 2), "Tr 0.25\nmap_Kd image.png\nmap_d holes.png")
    output, texture = converted(tmp_path / "m.obj")
    assert texture.is_plain
    assert (
        "note: paint: map_d is left out; what is clear has to be the alpha of map_Kd's own" in capsys.readouterr().out
    )
    assert elm.decode_all(output.read_bytes())[2].opacity == 191


def test_clear_places_are_told_of(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Image.new("RGBA", (4, 4), (9, 9, 9, 100)).save(tmp_path / "image.png")
    converted(square(tmp_path))
    assert "its image has clear places, which are drawn; give --alpha test or" in capsys.readouterr().out
    converted(tmp_path / "m.obj", "--alpha", "none")
    assert "clear places" not in capsys.readouterr().out
    Image.new("RGBA", (4, 4), (9, 9, 9, 0)).save(tmp_path / "image.png")
    for options in (["--alpha", "test"], ["--texture-format", "mask"]):
        told = refused("convert", tmp_path / "m.obj", "-o", tmp_path / "m.h", *options)
        assert told.startswith("m.obj: ") and "of the image" in told


# --- The report -------------------------------------------------------------------------------------------------------


def test_errors_and_bytes_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rgb = smooth_picture(64)
    Image.fromarray(rgb).save(tmp_path / "image.png")
    convert(
        *(square(tmp_path), "-o", tmp_path / "m.elm", "--json", "--texture-size", 64, "--mipmaps"),
        *("--texture-format", "palette4", "--dither", "ordered"),
    )
    found = json.loads(capsys.readouterr().out)
    texture = elm.decode((tmp_path / "m.elm").read_bytes())[1]
    assert texture is not None
    apart = np.abs(texture.colours().astype(int) - rgb)
    assert found["colour_error"] == {"rms": float(np.sqrt((apart * apart).mean())), "largest": int(apart.max())}
    parts = found["flash_parts"]
    assert parts["texels"] == 64 * 32 and parts["palette"] == 32
    assert parts["mipmaps"] == 32 * 16 + 16 * 8 + 8 * 4 + 4 * 2 + 2 * 1 + 1
    assert sum(parts.values()) == found["flash_bytes"] == found["mesh_bytes"] + found["texture_bytes"]
    assert found["meshes"][0]["texture_format"] == "palette4" and found["meshes"][0]["texture_levels"] == 7
    assert found["frame"]["at_least"] is True
    assert 0 <= found["position_rms"] <= found["position_error"]
    convert(tmp_path / "m.obj", "-o", tmp_path / "m.h", "--texture-format", "palette4")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("m, with normals, texture coordinates, a 64x64 texture (palette4)")
    assert any(line.startswith("  colours within ") for line in lines)


def test_the_same_bytes_in_another_process(edgeline: Edgeline, tmp_path: Path) -> None:
    """Whatever order sets and dictionaries have there."""
    Image.fromarray(smooth_picture(64)).save(tmp_path / "image.png")
    square(tmp_path)
    for form in ("palette8", "mask"):
        for output in ("m.h", "m.elm"):
            made = []
            for seed in ("1", "2"):
                words = ["m.obj", "-o", output, "--mipmaps", "--dither", "floyd-steinberg", "--texture-format", form]
                assert edgeline("convert", *words, env={"PYTHONHASHSEED": seed}).returncode == 0
                made.append((tmp_path / output).read_bytes())
            assert made[0] == made[1]


def test_texels_are_multiplied_by_vertex_colours(tmp_path: Path) -> None:
    """Those of a model that has both; white ones are left out."""

    def header(colours: Bytes) -> str:
        model = replace(ring(6, 4), colours=colours)
        gltf = Gltf()
        paint = gltf.material(image={"bufferView": gltf.view(checks()), "mimeType": "image/png"})
        gltf.node(gltf.primitive(model, attributes="ptc", material=paint))
        (tmp_path / "m.glb").write_bytes(gltf.glb())
        convert(tmp_path / "m.glb", "-o", tmp_path / "m.h")
        return (tmp_path / "m.h").read_text()

    colours = np.full_like(ring(6, 4).colours, 255)
    text = header(colours)
    assert ".shading = EL_SHADE_TEXTURED," in text and ".colours" not in text
    colours[-1] = 200, 255, 255
    text = header(colours)
    assert ".shading = EL_SHADE_TEXTURED_GOURAUD," in text and ".colours = m_colours," in text


def test_a_texture_stands_in_the_place_of_colours_where_the_format_has_no_product(tmp_path: Path) -> None:
    """A scan's PLY or OBJ has the same colours twice: at its vertices, and in its picture."""
    (tmp_path / "t.png").write_bytes(checks())
    (tmp_path / "m.mtl").write_text("newmtl a\nmap_Kd t.png\n")
    corners = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
    (tmp_path / "m.obj").write_text(f"mtllib m.mtl\n{corners}usemtl a\nf 1/1 2/2 3/3\n")
    convert(tmp_path / "m.obj", "-o", tmp_path / "m.h")
    assert ".colours" not in (tmp_path / "m.h").read_text()
    convert(tmp_path / "m.obj", "--no-texture", "-o", tmp_path / "m.h")
    assert ".colours = m_colours," in (tmp_path / "m.h").read_text()


def test_colours_of_materials_at_vertices_are_those_without_a_texture(tmp_path: Path) -> None:
    (tmp_path / "t.png").write_bytes(checks())
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 0.5 0 0\nmap_Kd t.png\nnewmtl b\nKd 0 1 0\n")
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
    (tmp_path / "m.obj").write_text(f"mtllib m.mtl\n{corners}usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1 3 2\n")
    convert(tmp_path / "m.obj", "--vertex-colours", "-o", tmp_path / "m.h")
    text = (tmp_path / "m.h").read_text()
    assert "m_a_colours" not in text and ".shading = EL_SHADE_TEXTURED," in text
    assert "m_b_colours[3][3] = {\n{0,255,0},{0,255,0},{0,255,0}," in text
