"""The picture in the window: whole scales, nothing blurred or shifted, the pixel grid, zoom and panning, the values
under the pointer, and what a frame did not carry."""

from __future__ import annotations

import numpy as np
import pytest

from edgeline import split
from edgeline.codec import PIXEL, Pixels
from edgeline.colour import to_rgb
from edgeline.events import Frame
from edgeline.protocol import Band, Codec, FrameEnd
from edgeline.viewer.paint import GRID_FROM, magnify
from edgeline.viewer.sent import sent
from edgeline.viewer.viewport import SCALES, Patch, Viewport, largest_scale
from fake_device import FakeDevice, PtyDevice, bars
from viewer_at_work import at_work, wait_for


def noise(width: int, height: int, seed: int = 1) -> Pixels:
    return np.random.default_rng(seed).integers(0, 65536, (height, width), PIXEL)


def test_the_scale_is_the_largest_whole_number_that_fits() -> None:
    assert [largest_scale(320, 240, *room) for room in ((1, 1), (639, 999), (640, 480), (2000, 719))] == [1, 1, 2, 2]
    assert largest_scale(128, 64, 1280, 1280) == 10  # a wide panel keeps its shape
    assert largest_scale(240, 320, 1280, 960) == 3  # so does an upright one


def test_a_picture_that_fits_stands_in_the_middle() -> None:
    viewport = Viewport(160, 120, 500, 400)
    assert viewport.patch() == Patch(0, 0, 160, 120, 10, 20, 3)
    viewport.resize(160, 120)
    assert viewport.patch() == Patch(0, 0, 160, 120, 0, 0, 1)


def test_zooming_keeps_the_point_under_the_pointer() -> None:
    random = np.random.default_rng(7)
    for _ in range(300):
        width, height, room_x, room_y = (int(n) for n in random.integers(20, 700, 4))
        viewport = Viewport(width, height, room_x, room_y)
        for _ in range(12):
            x, y = int(random.integers(0, room_x)), int(random.integers(0, room_y))
            before = viewport.pixel_at(x, y)
            viewport.zoom(int(random.integers(-3, 4)) or 1, x, y)
            scale, patch = viewport.scale, viewport.patch()
            assert scale in SCALES
            wide = width * scale >= room_x + 2 * scale * 64, height * scale >= room_y + 2 * scale * 64
            inner = patch.x0 > 0 and patch.x1 < width and patch.y0 > 0 and patch.y1 < height
            if before is not None and all(wide) and inner:
                assert viewport.pixel_at(x, y) == before
            # Where the picture is larger than the room it fills the room; else it is in the middle.
            for at, size, room, low, high in (
                (patch.left, width, room_x, patch.x0, patch.x1),
                (patch.top, height, room_y, patch.y0, patch.y1),
            ):
                if size * scale <= room:
                    assert (low, high, at) == (0, size, (room - size * scale) // 2)
                else:
                    assert at <= 0 and at + (high - low) * scale >= room and at > -scale


def test_panning_ends_at_the_picture_s_border() -> None:
    viewport = Viewport(100, 100, 200, 200)
    for _ in range(4):
        viewport.zoom(1, 100, 100)
    assert (viewport.scale, viewport.fits) == (6, False)
    viewport.pan(10_000, 10_000)
    assert viewport.patch() == Patch(0, 0, 34, 34, 0, 0, 6)
    viewport.pan(-10_000, -3)
    assert viewport.patch() == Patch(66, 0, 100, 34, -4, -3, 6)
    assert viewport.pixel_at(0, 0) == (66, 0)
    assert viewport.pixel_at(199, 199) == (99, 33)
    viewport.fit()
    assert viewport.patch() == Patch(0, 0, 100, 100, 0, 0, 2)
    assert viewport.pixel_at(-1, 0) is None
    assert viewport.pixel_at(200, 0) is None


def test_each_pixel_is_a_square() -> None:
    picture = noise(20, 10)
    patch = Patch(3, 2, 17, 9, 0, 0, 5)
    expected = to_rgb(picture)[2:9, 3:17].repeat(5, axis=0).repeat(5, axis=1)
    assert np.array_equal(np.asarray(magnify(picture, patch)), expected)


def test_the_grid_takes_one_line_of_each_square_and_can_be_seen_on_any_colour() -> None:
    picture = noise(20, 10)
    picture[0, :4] = 0x0000, 0xFFFF, 0x8410, 0x7BEF
    patch = Patch(0, 0, 20, 10, 0, 0, GRID_FROM)
    plain, grid = np.asarray(magnify(picture, patch)), np.asarray(magnify(picture, patch, grid=True))
    lines = np.zeros(plain.shape[:2], bool)
    lines[::GRID_FROM] = lines[:, ::GRID_FROM] = True
    assert np.array_equal(grid[~lines], plain[~lines])
    assert np.abs(grid[lines].astype(int) - plain[lines]).max(axis=-1).min() >= 40
    small = Patch(0, 0, 20, 10, 0, 0, GRID_FROM - 1)
    assert np.array_equal(np.asarray(magnify(picture, small, grid=True)), np.asarray(magnify(picture, small)))


def test_what_the_mask_leaves_out_is_dimmed_and_the_rest_is_exact() -> None:
    picture, patch = noise(8, 4), Patch(0, 0, 8, 4, 0, 0, 1)
    mask = np.random.default_rng(3).random((4, 8)) < 0.5
    shown = np.asarray(magnify(picture, patch, mask=mask))
    assert np.array_equal(shown[mask], to_rgb(picture)[mask])
    assert shown[~mask].max() <= 255 // 4 + 44


def frame_of(bands: tuple[Band, ...], width: int, height: int) -> Frame:
    return Frame(0, noise(width, height), FrameEnd(0, len(bands), 0, 0, 0, 0, 0, 0), bands=bands)


def test_what_a_frame_carried_is_known_to_the_pixel() -> None:
    raw = Band(0, 1, 2, Codec.RAW, b"", bytes(2 * 2 * 200))
    # Three lines: 64 pixels skipped, 6 literals, the rest skipped; a run of 200; 64 and 64 more skipped, a run of 72.
    run, more = split.RUN - 1, split.MORE - 1  # and the number of pixels, or of 16 pixels
    tokens = bytes((split.SKIP, split.LITERALS + 5, split.SKIP_TO_END, run + 8, split.MORE_TO_END))
    tokens += bytes((split.SKIP, more + 4, run + 8, more + 4))
    band = Band(0, 5, 3, Codec.SPLIT, tokens, bytes(12))
    came = sent(frame_of((raw, band), 200, 10))
    expected = np.zeros((10, 200), bool)
    expected[1:3] = True
    expected[5, 64:70] = True
    expected[6] = True
    expected[7, 128:200] = True
    assert np.array_equal(came, expected)
    assert not sent(frame_of((), 200, 10)).any()


def test_the_screen_has_the_frame_pixel_for_pixel(display: str) -> None:
    device = FakeDevice(160, 120, limit=30)
    last = to_rgb(bars(160, 120)(29))
    with PtyDevice(device) as served, at_work(display, served.port, scale=3) as viewer:
        viewer.until(lambda: viewer.model.frames == 30)
        viewer.settle()
        shown = viewer.screen()
        viewport = viewer.window.picture.viewport
        assert viewport is not None
        patch = viewport.patch()
        assert patch.scale == 3
        block = shown[patch.top : patch.top + 360, patch.left : patch.left + 480]
        assert np.array_equal(block, last.repeat(3, axis=0).repeat(3, axis=1))

        # The wheel zooms about the pointer; the grid's lines appear; the pixel under the pointer is named.
        x, y = patch.left + 3 * 100 + 1, patch.top + 3 * 70 + 1
        for _ in range(3):
            viewer.canvas.event_generate("<Button-4>", x=x, y=y)
        viewer.press("g")
        viewer.canvas.event_generate("<Motion>", x=x, y=y)
        viewer.settle()
        patch = viewport.patch()
        assert patch.scale == 6
        assert viewport.pixel_at(x, y) == (100, 70)
        value = int(bars(160, 120)(29)[70, 100])
        colour = f"{value:04X}  r{value >> 11} g{value >> 5 & 63} b{value & 31}"
        assert viewer.window.status.pixel_text == f"100,70  {colour}"
        screen, grid = viewer.screen(), np.asarray(magnify(bars(160, 120)(29), patch, grid=True))
        assert (patch.left, patch.top) <= (0, 0)
        seen = grid[-patch.top :, -patch.left :][: screen.shape[0], : screen.shape[1]]
        assert np.array_equal(screen, seen)

        # Dragging moves it by as many pixels; z brings all of it back.
        viewer.canvas.event_generate("<ButtonPress-1>", x=200, y=200)
        viewer.canvas.event_generate("<B1-Motion>", x=188, y=206)
        viewer.root.update()
        moved = viewport.patch()
        assert (moved.left - moved.x0 * 6) - (patch.left - patch.x0 * 6) == -12
        viewer.press("z")
        assert viewport.fits


def test_a_picture_that_comes_before_the_window_is_laid_out_gets_its_scale(display: str) -> None:
    with PtyDevice(FakeDevice(160, 120)) as served, at_work(display, served.port, scale=3) as viewer:
        wait_for(lambda: viewer.model.frames > 2)
        viewer.settle()
        assert (viewer.canvas.winfo_width(), viewer.canvas.winfo_height()) == (480, 360)


@pytest.mark.parametrize("size", [(128, 64), (240, 320)])
def test_other_panels_keep_their_shape(display: str, size: tuple[int, int]) -> None:
    width, height = size
    device = FakeDevice(width, height, limit=3)
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: viewer.model.frames == 3)
        viewer.settle()
        viewport = viewer.window.picture.viewport
        assert viewport is not None
        patch = viewport.patch()
        assert (patch.x1, patch.y1) == size
        block = viewer.screen()[patch.top : patch.top + patch.height, patch.left : patch.left + patch.width]
        picture = to_rgb(bars(width, height)(2)).repeat(patch.scale, axis=0).repeat(patch.scale, axis=1)
        assert np.array_equal(block, picture)
