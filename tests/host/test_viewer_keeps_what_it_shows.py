"""Screenshots and recordings from the viewer: exact, under a free name, and said in words when they fail."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from PIL import Image

from edgeline.colour import to_rgb
from edgeline.errors import OutputError
from edgeline.link import Link
from edgeline.playback import RecordingTransport
from edgeline.viewer import theme
from fake_device import FakeDevice, PtyDevice
from viewer_at_work import AtWork, at_work


def notices(viewer: AtWork) -> list[str]:
    return [line.text for line in viewer.model.log_since(0)[0] if line.source.value == "viewer"]


def record(viewer: AtWork) -> None:
    """Starts a recording, and waits until its first frame is in it."""
    viewer.press("r")
    viewer.until(lambda: viewer.reader.tap and viewer.reader.tap.state and viewer.reader.tap.state.received)


def test_a_screenshot_is_the_frame_that_is_shown_pixel_for_pixel(display: str, tmp_path: Path) -> None:
    (tmp_path / "edgeline-0001.png").write_bytes(b"mine")
    device = FakeDevice()
    with PtyDevice(device) as served, at_work(display, served.port, tmp_path) as viewer:
        viewer.until(lambda: viewer.model.frames > 5)
        viewer.press("<space>", "s")
        shown = viewer.model.shown
        assert shown is not None
        viewer.until(lambda: viewer.model.frames > 10)
        viewer.press("s")
    for number in (2, 3):
        saved = np.asarray(Image.open(tmp_path / f"edgeline-000{number}.png"))
        assert np.array_equal(saved, to_rgb(device.sent[shown.number]))
    assert (tmp_path / "edgeline-0001.png").read_bytes() == b"mine"
    assert len(list(tmp_path.iterdir())) == 3


def test_a_recording_begins_in_mid_stream_and_holds_each_frame_as_it_was(display: str, tmp_path: Path) -> None:
    device = FakeDevice(split=True)
    with PtyDevice(device) as served, at_work(display, served.port, tmp_path) as viewer:
        viewer.until(lambda: viewer.model.frames > 5)
        record(viewer)
        viewer.settle()
        red = (viewer.screen() == theme.rgb(theme.RECORDING)).all(axis=-1)
        assert red[:40, red.shape[1] // 2 :].sum() > 50, "no red mark in the upper right corner"
        begun = viewer.model.frames
        viewer.until(lambda: viewer.model.frames > begun + 20)
        viewer.press("r")
        viewer.settle()
        assert not (viewer.screen() == theme.rgb(theme.RECORDING)).all(axis=-1)[:40].any()
        first, last = notices(viewer)
        assert first == f"recording {tmp_path / 'edgeline-0001.elrec'}"
        assert last.startswith(f"recorded {tmp_path / 'edgeline-0001.elrec'}: ")
    frames = list(Link(RecordingTransport(str(tmp_path / "edgeline-0001.elrec"))))
    assert len(frames) > 20
    assert frames[0].number > 0
    assert [frame.number for frame in frames] == list(range(frames[0].number, frames[0].number + len(frames)))
    assert all(np.array_equal(frame.picture, device.sent[frame.number]) for frame in frames)

    # Played, it shows the same, takes no keys, and at its end says so and stays.
    with at_work(display, str(tmp_path / "edgeline-0001.elrec")) as viewer:
        viewer.until(lambda: viewer.line == "the stream has ended; this is its last frame")
        assert viewer.model.frames == len(frames)
        assert viewer.controls.known == frozenset()
        assert viewer.view.picture is not None
        assert np.array_equal(viewer.view.picture, frames[-1].picture)


def test_a_window_that_is_closed_completes_its_recording(display: str, tmp_path: Path) -> None:
    with PtyDevice(FakeDevice()) as served, at_work(display, served.port, tmp_path) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        record(viewer)
        begun = viewer.model.frames
        viewer.until(lambda: viewer.model.frames > begun + 2)
        viewer.press("q")
    assert len(list(Link(RecordingTransport(str(tmp_path / "edgeline-0001.elrec"))))) > 2


def test_what_cannot_be_written_is_said_and_nothing_stops(display: str, tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    with PtyDevice(FakeDevice()) as served, at_work(display, served.port, gone) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        viewer.press("s", "r")
        viewer.until(lambda: len(notices(viewer)) >= 2)
        assert [text.startswith(f"{gone}/edgeline-0001") for text in notices(viewer)] == [True, True]
        assert all("cannot be written" in text for text in notices(viewer))
        seen = viewer.model.frames
        viewer.until(lambda: viewer.model.frames > seen + 5)


def test_a_recording_that_fails_on_the_way_is_said(display: str, tmp_path: Path) -> None:
    with PtyDevice(FakeDevice()) as served, at_work(display, served.port, tmp_path) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        record(viewer)
        tap = viewer.reader.tap
        assert tap is not None
        tap.stop()
        tap.failure = OutputError("no space left")
        viewer.until(lambda: "the recording has ended: no space left" in notices(viewer))
        assert viewer.view.notice == "the recording has ended: no space left"
        assert viewer.model.view(time.monotonic() + 60).notice == ""
        viewer.press("r")  # the next one may have more luck
        viewer.until(lambda: any("edgeline-0002.elrec" in text for text in notices(viewer)))
