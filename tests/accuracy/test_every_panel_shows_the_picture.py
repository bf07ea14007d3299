"""Every panel shows the renderer's picture, however it is mounted; what the wire carries is judged by its chip's rules.

`render --panel` draws through the driver, the wire and the model of the chip; `render --wire` keeps what the wire
carried, and `look` judges that again. The faults at the end are put into such a trace one by one: each must be found.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from golden import expect_golden
from sim_commands import Simulator

COLOUR = {"ili9341": (240, 320), "st7789": (240, 320), "st7789-240x240": (240, 240), "st7735": (128, 160)}
GREY = {"ssd1306": (128, 64), "ssd0323": (128, 64)}
PANELS = COLOUR | GREY
ROTATIONS = (0, 90, 180, 270)

Pixels = npt.NDArray[np.uint16]
Look = Callable[..., Pixels]
Record = tuple[int, int, int]
"""Kind, value and, for kind 3, nanoseconds of a record of a wire trace."""

COMMAND, DATA, RESET, TIME = range(4)


def _size(panel: str, rotation: int) -> tuple[int, int]:
    """Width and height as the viewer sees them."""
    columns, rows = PANELS[panel]
    return (rows, columns) if rotation % 180 else (columns, rows)


def _draw(simulator: Simulator, folder: Path, panel: str, rotation: int, *arguments: str) -> tuple[Pixels, Path]:
    """What the glass shows of the demo's first frame, and the trace of the wire."""
    raw, wire = folder / "drawn.rgb565", folder / "drawn.trace"
    simulator.run_well(
        *("render", "--scene", "demo", "--panel", panel, "--rotation", str(rotation)),
        *("--raw", str(raw), "--wire", str(wire), *arguments),
    )
    width, height = _size(panel, rotation)
    return np.fromfile(raw, "<u2").reshape(height, width), wire


@pytest.fixture
def look(checked_simulator: Simulator, tmp_path: Path) -> Look:
    """What the glass shows after a trace; fails where the chip would not take it."""

    def run(wire: Path, panel: str, rotation: int) -> Pixels:
        raw = tmp_path / "looked.rgb565"
        checked_simulator.run_well("look", "--panel", panel, "--rotation", str(rotation), str(wire), "--raw", str(raw))
        width, height = _size(panel, rotation)
        return np.fromfile(raw, "<u2").reshape(height, width)

    return run


@pytest.mark.parametrize("rotation", ROTATIONS)
@pytest.mark.parametrize("panel", PANELS)
def test_the_trace_of_the_wire_looks_like_the_glass(
    checked_simulator: Simulator, tmp_path: Path, look: Look, panel: str, rotation: int
) -> None:
    drawn, wire = _draw(checked_simulator, tmp_path, panel, rotation)
    assert len(np.unique(drawn)) > (1 if panel == "ssd1306" else 8), "the picture is empty"
    np.testing.assert_array_equal(drawn, look(wire, panel, rotation))


@pytest.mark.parametrize("rotation", ROTATIONS)
@pytest.mark.parametrize("panel", COLOUR)
def test_colour_panels_show_every_pixel_as_rendered(
    simulator: Simulator, tmp_path: Path, panel: str, rotation: int
) -> None:
    width, height = _size(panel, rotation)
    plain = tmp_path / "plain.rgb565"
    simulator.run_well("render", "--scene", "demo", "--size", f"{width}x{height}", "--raw", str(plain))
    drawn, _ = _draw(simulator, tmp_path, panel, rotation)
    np.testing.assert_array_equal(drawn.ravel(), np.fromfile(plain, "<u2"))


@pytest.mark.parametrize("panel", GREY)
def test_grey_panels_look_the_same_from_every_side(checked_simulator: Simulator, tmp_path: Path, panel: str) -> None:
    upright, _ = _draw(checked_simulator, tmp_path, panel, 0)
    left, _ = _draw(checked_simulator, tmp_path, panel, 90)
    np.testing.assert_array_equal(upright, _draw(checked_simulator, tmp_path, panel, 180)[0])
    np.testing.assert_array_equal(left, _draw(checked_simulator, tmp_path, panel, 270)[0])


@pytest.mark.parametrize("panel", PANELS)
def test_a_smaller_frame_is_the_upper_left_part_on_black(
    checked_simulator: Simulator, tmp_path: Path, look: Look, panel: str
) -> None:
    drawn, wire = _draw(checked_simulator, tmp_path, panel, 90, "--size", "61x59")
    assert drawn[:59, :61].any()
    assert not drawn[59:].any() and not drawn[:, 61:].any()
    np.testing.assert_array_equal(drawn, look(wire, panel, 90))


@pytest.mark.parametrize("panel", GREY)
def test_grey_pictures_as_somebody_looked_at_them(
    checked_simulator: Simulator, reports: Path, tmp_path: Path, panel: str
) -> None:
    """After a wanted change: EDGELINE_UPDATE_GOLDEN=1, and look at the pictures before committing them."""
    png = tmp_path / "drawn.png"
    _draw(checked_simulator, tmp_path, panel, 0, "--png", str(png))
    expect_golden(Image.open(png).convert("RGB"), f"demo-{panel}", reports)


def _records(trace: bytes) -> list[Record]:
    assert trace[:4] == b"HOT1"
    records, at = [], 4
    while at < len(trace):
        kind, value = trace[at], trace[at + 1]
        ns = struct.unpack_from("<I", trace, at + 2)[0] if kind == TIME else 0
        records.append((kind, value, ns))
        at += 6 if kind == TIME else 2
    return records


def _trace(records: list[Record]) -> bytes:
    parts = [struct.pack("<2BI" if r[0] == TIME else "<2B", *r[: 3 if r[0] == TIME else 2]) for r in records]
    return b"HOT1" + b"".join(parts)


def _index(records: list[Record], kind: int, value: int, nth: int = 0) -> int:
    return [i for i, record in enumerate(records) if record[:2] == (kind, value)][nth]


def _command_bytes(records: list[Record]) -> list[int]:
    return [i for i, record in enumerate(records) if record[0] == COMMAND]


def _no_wait_after_reset(records: list[Record]) -> None:
    at = _index(records, RESET, 1)
    assert records[at + 1][0] == TIME
    records[at + 1] = (TIME, 0, 100)


def _short_reset(records: list[Record]) -> None:
    at = _index(records, RESET, 0)
    assert records[at + 1][0] == TIME
    records[at + 1] = (TIME, 0, 2000)


def _data_too_early(records: list[Record]) -> None:
    """D/C rises while the last command before the pixels is still being sent."""
    pixels = max(_command_bytes(records))
    records[pixels] = (DATA, *records[pixels][1:])


def _command_too_late(records: list[Record]) -> None:
    """D/C stays high while the next command is being sent."""
    first = _command_bytes(records)[1]
    records[first] = (DATA, *records[first][1:])


def _late_data(records: list[Record]) -> int:
    """A byte of the picture's last quarter."""
    return next(i for i in range(len(records) * 3 // 4, len(records)) if records[i][0] == DATA)


def _a_byte_lost(records: list[Record]) -> None:
    del records[_late_data(records)]


def _a_byte_doubled(records: list[Record]) -> None:
    at = _late_data(records)
    records.insert(at, records[at])


def _two_bytes_exchanged(records: list[Record]) -> None:
    pixels = max(_command_bytes(records))
    at = next(
        i
        for i in range(pixels + 1, len(records) - 1)
        if records[i][0] == records[i + 1][0] == DATA and records[i][1] != records[i + 1][1]
    )
    records[at], records[at + 1] = records[at + 1], records[at]


def _wrong_window(records: list[Record]) -> None:
    """The last window of columns begins one too far."""
    low_byte_of_start = {0x2A: 2, 0x21: 1, 0x15: 1}
    at = max(i for i, record in enumerate(records) if record[0] == COMMAND and record[1] in low_byte_of_start)
    bytes_after = [i for i in range(at + 1, len(records)) if records[i][0] in (COMMAND, DATA)]
    start = bytes_after[low_byte_of_start[records[at][1]] - 1]
    kind, value, _ = records[start]
    records[start] = (kind, value + 1, 0)


def _another_command(records: list[Record]) -> None:
    at = _command_bytes(records)[2]
    records[at] = (COMMAND, 0xFD, 0)


FAULTS = {
    fault.__name__.strip("_"): fault
    for fault in (
        _no_wait_after_reset,
        _short_reset,
        _data_too_early,
        _command_too_late,
        _a_byte_lost,
        _a_byte_doubled,
        _two_bytes_exchanged,
        _wrong_window,
        _another_command,
    )
}


@pytest.fixture(scope="module")
def good(simulator: Simulator, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[Pixels, bytes]]:
    """A panel's picture and its trace without a fault, upright."""
    made: dict[str, tuple[Pixels, bytes]] = {}

    def run(panel: str) -> tuple[Pixels, bytes]:
        if panel not in made:
            drawn, wire = _draw(simulator, tmp_path_factory.mktemp("good"), panel, 0)
            made[panel] = drawn, wire.read_bytes()
        return made[panel]

    return run


@pytest.mark.parametrize("panel", ["ili9341", "st7789-240x240", "st7735", "ssd1306", "ssd0323"])
@pytest.mark.parametrize("fault", FAULTS)
def test_a_seeded_fault_is_found(
    simulator: Simulator, good: Callable[[str], tuple[Pixels, bytes]], tmp_path: Path, panel: str, fault: str
) -> None:
    """By an error in words, or by another picture."""
    drawn, trace = good(panel)
    records = _records(trace)
    assert _trace(records) == trace
    FAULTS[fault](records)
    wire = tmp_path / "faulty.trace"
    wire.write_bytes(_trace(records))
    raw = tmp_path / "looked.rgb565"
    done = simulator.run("look", "--panel", panel, str(wire), "--raw", str(raw))
    if done.returncode == 0:
        looked = np.fromfile(raw, "<u2").reshape(drawn.shape)
        assert (looked != drawn).any(), "the glass shows the right picture, and the chip took it"
    else:
        assert done.returncode == 2 and len(done.stderr.splitlines()) == 1 and ": byte " in done.stderr, done
        assert not raw.exists()


BAD_TRACES = {
    "empty": (b"", "HOT1"),
    "another kind of file": (b"HOC1" + bytes(8), "HOT1"),
    "half a record": (b"HOT1\x00", "byte 4"),
    "half a time": (b"HOT1\x01\x02\x03\x00\x01\x02", "byte 6"),
    "an unknown record": (b"HOT1\x04\x00", "04h 00h"),
    "a level that is none": (b"HOT1\x02\x02", "02h 02h"),
    "a time with a value": (b"HOT1\x03\x01\x00\x00\x00\x00", "03h 01h"),
    "data before a command": (b"HOT1\x01\x55", "data 55h before any command"),
    "half a pixel at the end": (b"HOT1\x00\x2c\x01\x55", "pixel"),
}


@pytest.mark.parametrize("case", BAD_TRACES)
def test_bad_traces_get_one_clear_line(checked_simulator: Simulator, tmp_path: Path, case: str) -> None:
    trace, told = BAD_TRACES[case]
    path = tmp_path / "bad.trace"
    path.write_bytes(trace)
    done = checked_simulator.run("look", "--panel", "ili9341", str(path), "--raw", str(tmp_path / "out"))
    assert done.returncode == 2 and done.stdout == "", done
    assert len(done.stderr.splitlines()) == 1 and told in done.stderr and "bad.trace" in done.stderr, done.stderr
    assert not (tmp_path / "out").exists()


BAD_OPTIONS = {
    "unknown panel": (["render", "--panel", "hx8357"], "ili9341, st7789"),
    "panel in capitals": (["render", "--panel", "ST7735"], "st7735"),
    "rotation between": (["render", "--panel", "st7735", "--rotation", "45"], "0, 90, 180 or 270"),
    "rotation of nothing": (["render", "--rotation", "90"], "--panel"),
    "larger than the glass": (["render", "--panel", "st7735", "--size", "129x160"], "128x160"),
    "larger when turned": (["render", "--panel", "st7735", "--rotation", "90", "--size", "128x160"], "160x128"),
    "stream to an unknown panel": (["stream", "--stdout", "--panel", "hx8357"], "ili9341"),
    "stream larger than the glass": (["stream", "--stdout", "--panel", "ssd1306", "--size", "128x65"], "128x64"),
    "look without a panel": (["look", "x.trace"], "--panel"),
    "look without a trace": (["look", "--panel", "ssd1306"], "trace"),
    "look at two traces": (["look", "--panel", "ssd1306", "a", "b"], "one trace"),
    "look at no file": (["look", "--panel", "ssd1306", "no-such-file"], "no-such-file"),
    "look with an unknown option": (["look", "--panel", "ssd1306", "--crc", "x"], "--crc"),
    "number of another kind": (["render", "--png", "out%x.png"], "%04d"),
    "two numbers": (["render", "--png", "out%d%d.png"], "%04d"),
    "wire nowhere": (["render", "--wire", "no-such-folder/out.trace"], "no-such-folder"),
}


@pytest.mark.parametrize("case", BAD_OPTIONS)
def test_bad_options_get_one_clear_line(checked_simulator: Simulator, case: str) -> None:
    arguments, told = BAD_OPTIONS[case]
    done = checked_simulator.run(*arguments)
    assert done.returncode == 2 and done.stdout == "", done
    assert len(done.stderr.splitlines()) == 1 and told in done.stderr, done.stderr


def test_each_frame_has_its_png_where_the_name_has_a_number(checked_simulator: Simulator, tmp_path: Path) -> None:
    raw = tmp_path / "all.rgb565"
    checked_simulator.run_well(
        *("render", "--size", "40x30", "--frames", "12", "--png", str(tmp_path / "f%03d.png"), "--raw", str(raw))
    )
    names = sorted(path.name for path in tmp_path.glob("*.png"))
    assert names == [f"f{i:03}.png" for i in range(12)]
    green = np.fromfile(raw, "<u2").reshape(12, 30, 40) >> 5 & 63
    for i, name in enumerate(names):
        np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / name))[..., 1] >> 2, green[i])
    checked_simulator.run_well("render", "--size", "40x30", "--frames", "2", "--png", str(tmp_path / "%d.png"))
    assert (tmp_path / "0.png").exists() and (tmp_path / "1.png").exists()


@pytest.mark.parametrize("command", ["list", "render", "stream", "look", "memory", "coverage", "attributes", "methods"])
def test_each_command_tells_its_usage(checked_simulator: Simulator, command: str) -> None:
    for arguments in ([command, "--help"], [command, "-h"], [command, "--scene", "demo", "--help"]):
        done = checked_simulator.run(*arguments)
        assert done.returncode == 0 and done.stderr == "" and command in done.stdout, done


def test_the_version_and_all_panels_are_told(checked_simulator: Simulator) -> None:
    assert checked_simulator.run_well("--version").startswith("edgeline-sim 0.")
    usage = checked_simulator.run_well("--help")
    assert all(panel in usage for panel in PANELS)
