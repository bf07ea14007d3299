"""`edgeline verify`: exit code 0 for the very pictures alone, of a device that is asked, one that plays, a file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from edgeline import golden
from edgeline.cli import main
from edgeline.codec import PIXEL
from edgeline.colour import to_rgb
from edgeline.errors import EdgelineError
from edgeline.golden import Golden, Place, Shown
from edgeline.picture import digest_of
from edgeline.protocol import Control, Input
from edgeline.verify import side_by_side
from fake_device import FakeDevice, PtyDevice, TcpDevice, _Served, bars
from faults import Faults
from recorded import SCENES, PlayingDevice, picture_at, write_recording

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs `edgeline verify ARGUMENTS` here, in the test's folder: its status and output."""
    monkeypatch.chdir(tmp_path)

    def verify(*arguments: str) -> tuple[int, str, str]:
        status = main(["verify", *arguments])
        said = capsys.readouterr()
        return status, said.out, said.err

    return verify


def golden_at(scene: int | None, frame: int) -> Golden:
    picture = bars()(frame) if scene is None else picture_at(scene, frame)
    return Golden(Place(scene, frame), 48, 32, digest_of(picture))


def write(path: Path, *goldens: Golden) -> None:
    golden.write(str(path), goldens)


PLACES = [(2, 7), (2, 3), (0, 0), (3, 41), (0, 1)]


@pytest.mark.parametrize("link", [PtyDevice, TcpDevice])
def test_a_device_is_asked_for_each_picture(link: type[_Served], run: Run, tmp_path: Path) -> None:
    write(tmp_path / "a.crc", *(golden_at(*place) for place in PLACES))
    device = PlayingDevice(split=True)
    with link(device) as served:
        assert run("a.crc", "-p", served.port) == (0, "a.crc: 5 of 5 pictures are equal\n", "")
    assert not device.paused  # it goes on


def test_over_a_bad_link_too(run: Run, tmp_path: Path) -> None:
    write(tmp_path / "a.crc", *(golden_at(*place) for place in PLACES))
    faults = Faults(3, flip=0.02, drop=0.02, cut=0.02, duplicate=0.02, noise=0.02)
    with PtyDevice(PlayingDevice(split=True, faults=faults)) as served:
        assert run("a.crc", "-p", served.port)[0] == 0


def test_what_differs_is_listed_and_drawn(run: Run, tmp_path: Path) -> None:
    """A digest that is wrong, a size that is, a scene that is not there; beside the reference's picture."""
    wrong = [
        Golden(Place(1, 5), 48, 32, digest_of(picture_at(1, 6))),
        Golden(Place(1, 6), 40, 32, digest_of(picture_at(1, 6))),
        Golden(Place(SCENES, 0), 48, 32, 0x1234),
    ]
    write(tmp_path / "a.crc", golden_at(0, 2), *wrong)
    with PtyDevice(PlayingDevice()) as served, PtyDevice(Off()) as other:
        status, out, err = run("a.crc", "-p", served.port, "--json", "--diff", "d/e", "-r", other.port)
    assert status == 1
    assert err == f"edgeline: {other.port}: shows 1 of the 2 golden pictures that differ\n"
    told = json.loads(out)
    assert (told["equal"], told["different"]) == (1, 3)
    assert [row["verdict"] for row in told["frames"]] == ["equal", "differs", "is 48x32", "not shown"]
    assert told["frames"][1]["shown"]["digest"] == f"{digest_of(picture_at(1, 5)):08x}"
    assert told["frames"][3]["shown"] == {"width": None, "height": None, "digest": None}
    names = [row["picture"] for row in told["frames"]]
    assert names == [None, "d/e/scene1-frame5.png", "d/e/scene1-frame6.png", None]
    expected, shown = to_rgb(picture_at(1, 6)), to_rgb(picture_at(1, 5))
    drawn = np.asarray(Image.open(tmp_path / names[1]))
    assert np.array_equal(drawn[:, :48], expected)
    assert np.array_equal(drawn[:, 52:100], shown)
    differ = (expected != shown).any(axis=2)
    assert np.array_equal((drawn[:, 104:] == 255).all(axis=2), differ)
    assert np.array_equal(np.asarray(Image.open(tmp_path / names[2])), to_rgb(picture_at(1, 6)))


class Off(PlayingDevice):
    """A device that is one frame ahead of every other."""

    def _next_place(self) -> tuple[int, int]:
        scene, frame = super()._next_place()
        return scene, frame + 1


def test_the_table_has_the_first_differences(run: Run, tmp_path: Path) -> None:
    write(tmp_path / "a.crc", *(Golden(Place(0, frame), 48, 32, 7) for frame in range(12)), golden_at(1, 1))
    with PtyDevice(PlayingDevice()) as served:
        status, out, _ = run("a.crc", "-p", served.port)
    lines = out.splitlines()
    assert status == 1
    assert lines[1] == f"    0          0  00000007  {digest_of(picture_at(0, 0)):08x}  differs"
    assert lines[11:] == ["... and 2 more", "a.crc: 1 of 13 pictures are equal"]


def test_update_writes_what_the_device_shows(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "a.crc"
    with PtyDevice(PlayingDevice()) as served:
        assert run("a.crc", "-p", served.port, "--update", "--frames", "2")[0] == 0
        assert golden.read("a.crc") == [golden_at(scene, frame) for scene in range(SCENES) for frame in range(2)]
        write(path, Golden(Place(1, 9), 8, 8, 0), golden_at(0, 4), Golden(Place(2, 1), 1, 1, 1))
        _, out, _ = run("a.crc", "-p", served.port, "--update", "--scene", "1", "--json")
        assert json.loads(out) == {"golden": "a.crc", "written": 1, "changed": 1}
        assert golden.read("a.crc") == [golden_at(1, 9), golden_at(0, 4), Golden(Place(2, 1), 1, 1, 1)]
        assert run("a.crc", "-p", served.port)[0] == 1
        assert run("a.crc", "-p", served.port, "--frames", "5")[0] == 1  # scene 2's frame 1 is among them
        assert run("a.crc", "-p", served.port, "--scene", "0")[0] == 0
        write(path, Golden(Place(SCENES, 0), 8, 8, 0))
        before = path.read_bytes()
        assert run("a.crc", "-p", served.port, "--update")[0] == 4
        assert path.read_bytes() == before


def test_a_device_without_input_is_watched(run: Run, tmp_path: Path) -> None:
    write(tmp_path / "a.crc", golden_at(None, 3), golden_at(None, 9))
    with TcpDevice(FakeDevice(takes_input=False)) as served:
        assert run("a.crc", "-p", served.port)[0] == 0
    write(tmp_path / "a.crc", golden_at(0, 3))
    with TcpDevice(FakeDevice(takes_input=False)) as served:
        port = served.port
        status, _, err = run("a.crc", "-p", port)
    assert (status, err) == (3, f"edgeline: {port}: takes no INPUT, so no scene's frame can be asked for\n")
    with TcpDevice(FakeDevice(takes_input=False)) as served:
        assert run("b.crc", "-p", served.port, "--update", "--frames", "4")[0] == 0
    assert golden.read("b.crc") == [golden_at(None, frame) for frame in range(4)]


def test_a_recording_is_watched(run: Run, tmp_path: Path) -> None:
    write_recording(tmp_path / "a.elrec", 12)
    assert run("a.crc", "-p", "a.elrec", "--update")[0] == 0
    assert golden.read("a.crc") == [golden_at(None, frame) for frame in range(8)]
    assert run("a.crc", "-p", "a.elrec")[0] == 0
    write(tmp_path / "a.crc", golden_at(None, 11), golden_at(None, 12))
    status, out, _ = run("a.crc", "-p", "a.elrec", "--json")
    assert (status, [row["verdict"] for row in json.loads(out)["frames"]]) == (1, ["equal", "not shown"])


def test_what_a_device_was_asked_is_in_its_recording(run: Run, tmp_path: Path) -> None:
    """The evidence of one run verifies again, and shows a wrong golden file wrong."""
    write(tmp_path / "a.crc", *(golden_at(*place) for place in PLACES))
    with PtyDevice(PlayingDevice(split=True)) as served:
        assert run("a.crc", "-p", served.port, "--record", "e.elrec")[0] == 0
    assert run("a.crc", "-p", "e.elrec")[0] == 0
    write(tmp_path / "b.crc", *(golden_at(*place) for place in PLACES[:4]), Golden(Place(0, 1), 48, 32, 5))
    assert run("b.crc", "-p", "e.elrec")[0] == 1
    assert run("c.crc", "-p", "e.elrec", "--update", "--frames", "50")[0] == 0
    assert set(golden.read("c.crc")) >= {golden_at(*place) for place in PLACES}
    assert all(entry == golden_at(entry.place.scene, entry.place.frame) for entry in golden.read("c.crc"))


def test_a_link_that_is_lost_says_so(run: Run, tmp_path: Path) -> None:
    write(tmp_path / "a.crc", *(golden_at(*place) for place in PLACES))
    with PtyDevice(PlayingDevice(limit=4)) as served:
        status, out, err = run("a.crc", "-p", served.port, "--timeout", "0.5")
    assert status == 4
    assert "no verified frame" in err
    assert "of 5 pictures are equal" in out


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("", "holds no pictures"),
        ("# remarks\n\n", "holds no pictures"),
        ("0 1 48 32 0000000", "line 1: expected"),
        ("0 1 48 32 12345678\n\n0 1 48 32 00000000 # again\n", "line 3: scene and frame 0 1 stand there twice"),
        ("x 1 48 32 12345678", "line 1"),
        ("0 -1 48 32 12345678", "line 1"),
        ("0 1 0 32 12345678", "line 1"),
        ("0 1 48 2041 12345678", "line 1"),
        ("2147483648 1 48 32 12345678", "line 1"),
        ("0 1 48 32 1234567g", "line 1"),
    ],
)
def test_golden_files_that_are_none(content: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "a.crc").write_text(content)
    with pytest.raises(EdgelineError, match=said):
        golden.read(str(tmp_path / "a.crc"))


def test_golden_files_are_read_as_written(tmp_path: Path) -> None:
    goldens = [golden_at(None, 0), Golden(Place(2**31 - 1, 2**31 - 1), 2040, 1, 0xFFFFFFFF), golden_at(0, 3)]
    write(tmp_path / "a.crc", *goldens)
    assert golden.read(str(tmp_path / "a.crc")) == goldens
    (tmp_path / "a.crc").write_text("  0\t10 320   240 9BD7ddd6  # as it should be\r\n", newline="")
    assert golden.read(str(tmp_path / "a.crc")) == [Golden(Place(0, 10), 320, 240, 0x9BD7DDD6)]


def test_where_a_recorded_device_was() -> None:
    """INPUTs count when the device has taken them, once each, and only those that choose what is seen."""
    shown = Shown()
    told = [(Control.PAUSE, 1), (Control.SCENE, 2), (Control.FRAME, 7), (Control.STEP, 3), (Control.YAW, 5)]
    for number, (control, value) in enumerate(told, start=254):
        for _ in range(2):  # told twice, as on a bad link
            shown.told(Input(control, value, number & 0xFF))
    assert shown.place(253, 0) is None
    assert shown.place(255, 0) == Place(2, 0)
    assert shown.place(0, 0) == Place(2, 7)
    shown.told(Input(Control.SCENE, 1, 255))  # comes late
    assert shown.place(1, 0) == Place(2, 10)
    assert shown.place(2, 0) is None
    for number, (control, value) in enumerate([(Control.YAW, 0), (Control.SCENE, 9), (Control.PAUSE, 0)], start=3):
        shown.told(Input(control, value, number))
    assert shown.place(3, 4) == Place(2, 10)
    assert shown.place(4, 4) == Place(2, 10)  # there are only four scenes
    assert shown.place(5, 4) is None
    shown.told(Input(Control.SCENE, 1, None))
    shown.told(Input(Control.PAUSE, 1, 6))
    assert shown.place(6, 4) is None  # it stands still, who knows where


def test_a_picture_of_another_size_has_no_difference() -> None:
    picture = np.full((2, 2), 0xFFFF, PIXEL)
    assert side_by_side(np.zeros((2, 3), PIXEL), picture) is picture
    assert side_by_side(None, picture) is picture
