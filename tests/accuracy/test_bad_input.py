"""Whatever the command line or a file says: exit status 2, one clear line, no output file, no crash."""

from __future__ import annotations

import signal
import struct
import subprocess
import time
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sim_commands import Simulator

BAD_RENDERS = {
    "unknown scene": ["--scene", "no-such-scene"],
    "no value": ["--scene"],
    "unknown option": ["--no-such-option"],
    "size of one number": ["--size", "320"],
    "size zero": ["--size", "0x240"],
    "size negative": ["--size", "-320x240"],
    "size too large": ["--size", "4000x240"],
    "size far too large": ["--size", "99999999999x240"],
    "size with rubbish": ["--size", "320x240x1"],
    "size empty": ["--size", ""],
    "band zero": ["--band", "0"],
    "band negative": ["--band", "-1"],
    "band no number": ["--band", "eight"],
    "band with rubbish": ["--band", "8lines"],
    "frames zero": ["--frames", "0"],
    "frames negative": ["--frames", "-3"],
    "frames no number": ["--frames", "many"],
    "frames beyond 64 bits": ["--frames", "99999999999999999999"],
    "arena too small": ["--arena", "1"],
    "arena no number": ["--arena", "big"],
    "arena negative": ["--arena", "-4096"],
    "mesh missing": ["--mesh", "missing.elm"],
    "mesh is a folder": ["--mesh", "."],
    "scene and mesh": ["--scene", "S1", "--mesh", "missing.elm"],
    "65 meshes": ["--mesh", "missing.elm"] * 65,
}

BAD_CAMERAS = {
    "eye of two numbers": ["--eye=1,2"],
    "eye no number": ["--eye=1,2,z"],
    "eye infinite": ["--eye=inf,0,0"],
    "eye not a number": ["--eye=nan,0,0"],
    "eye far away": ["--eye=1e30,0,0"],
    "eye at its target": ["--eye=1,1,1", "--look-at=1,1,1"],
    "field of view zero": ["--fov=0"],
    "field of view straight": ["--fov=180"],
    "near zero": ["--near=0"],
    "near negative": ["--near=-1"],
    "far before near": ["--near=2", "--far=1"],
    "shading unknown": ["--shading=shiny"],
    "textured without texture": ["--shading=textured"],
}


def _elm(**changes: int) -> bytes:
    """A triangle as .elm, with header members changed: major, size, vertices, triangles, scale, content, index."""
    positions = np.array([[0, 0, 0], [900, 0, 0], [0, 900, 0]], "<i2").tobytes() + bytes(2)
    index = changes.get("index", 2)
    triangles = np.array([0, 1, index], "<u2").tobytes() + bytes(2)
    head = struct.pack(
        "<HHbBBB3hH",
        changes.get("vertices", 3),
        changes.get("triangles", 1),
        changes.get("scale", -9),
        changes.get("content", 0),
        *(0, 0, 450, 450, 0),
        changes.get("radius", 640),
    )
    body = head + positions + triangles
    size = changes.get("size", 16 + len(body))
    crc = zlib.crc32(body) ^ changes.get("damage", 0)
    return struct.pack("<4sHHII", b"ELM\x1a", changes.get("major", 1), 0, size, crc) + body


BAD_MESHES = {
    "empty": b"",
    "text": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "newer version": _elm(major=2),
    "wrong CRC": _elm(damage=1),
    "size too small": _elm(size=20),
    "size too large": _elm(size=1 << 30),
    "no vertices": _elm(vertices=0),
    "more vertices than bytes": _elm(vertices=60000),
    "more triangles than bytes": _elm(triangles=60000),
    "index out of range": _elm(index=3),
    "scale out of range": _elm(scale=100),
    "unknown content": _elm(content=64),
    "texture without coordinates": _elm(content=16),
    "sphere too small": _elm(radius=3),
    "trailing bytes": _elm() + bytes(4),
}

Fails = Callable[..., str]


@pytest.fixture
def fails(checked_simulator: Simulator, tmp_path: Path) -> Fails:
    """Runs the simulator, in an empty folder's name, and returns its one line; fails when it is not as promised."""

    def run(*arguments: str) -> str:
        done = checked_simulator.run(*arguments, timeout=20)
        told = f"edgeline-sim {' '.join(arguments)}: status {done.returncode}, stderr {done.stderr!r}"
        assert done.returncode == 2, told
        lines = done.stderr.splitlines()
        assert len(lines) == 1 and 10 <= len(lines[0]) <= 300 and lines[0].isprintable(), told
        assert done.stdout == "", f"{told}; stdout {done.stdout[:200]!r}"
        left = [path.name for path in tmp_path.iterdir() if path.name.startswith("out")]
        assert left == [], f"{told}; left behind: {left}"
        return lines[0]

    return run


@pytest.fixture
def outputs(tmp_path: Path) -> list[str]:
    """Options for every kind of output."""
    return [f"--png={tmp_path / 'out.png'}", f"--raw={tmp_path / 'out.rgb'}", f"--depth={tmp_path / 'out.depth'}"]


@pytest.fixture
def good_mesh(tmp_path: Path) -> str:
    path = tmp_path / "good.elm"
    path.write_bytes(_elm())
    return str(path)


def test_good_input_is_good(checked_simulator: Simulator, good_mesh: str, outputs: list[str]) -> None:
    """Without this, a simulator that refuses everything would pass all the other tests."""
    done = checked_simulator.run("render", "--mesh", good_mesh, "--shading", "flat", "--crc", *outputs)
    assert (done.returncode, done.stderr) == (0, "")
    assert all(Path(option.partition("=")[2]).stat().st_size > 0 for option in outputs)


@pytest.mark.parametrize("arguments", [[], ["no-such-command"], ["--no-such-option"], ["list", "too much"]])
def test_bad_commands(fails: Fails, arguments: list[str]) -> None:
    fails(*arguments)


@pytest.mark.parametrize("case", BAD_RENDERS)
def test_bad_render_options(fails: Fails, outputs: list[str], case: str) -> None:
    message = fails("render", *outputs, *BAD_RENDERS[case])
    assert BAD_RENDERS[case][0].lstrip("-") in message or BAD_RENDERS[case][-1] in message, message


@pytest.mark.parametrize("case", BAD_CAMERAS)
def test_bad_cameras(fails: Fails, good_mesh: str, outputs: list[str], case: str) -> None:
    fails("render", "--mesh", good_mesh, *outputs, *BAD_CAMERAS[case])


@pytest.mark.parametrize("case", BAD_MESHES)
def test_bad_meshes(fails: Fails, tmp_path: Path, outputs: list[str], case: str) -> None:
    path = tmp_path / "bad.elm"
    path.write_bytes(BAD_MESHES[case])
    message = fails("render", "--mesh", str(path), *outputs)
    assert "bad.elm" in message, message


def test_a_newer_mesh_is_called_newer(fails: Fails, tmp_path: Path) -> None:
    path = tmp_path / "bad.elm"
    path.write_bytes(BAD_MESHES["newer version"])
    message = fails("render", "--mesh", str(path))
    assert "newer" in message or "version" in message, message


def test_meshes_cut_anywhere(fails: Fails, tmp_path: Path, outputs: list[str]) -> None:
    data = _elm()
    path = tmp_path / "bad.elm"
    for length in range(len(data)):
        path.write_bytes(data[:length])
        fails("render", "--mesh", str(path), *outputs)


@pytest.mark.parametrize("option", ["--png", "--raw", "--depth"])
def test_outputs_that_cannot_be_written(fails: Fails, tmp_path: Path, good_mesh: str, option: str) -> None:
    for place in (tmp_path / "no-such-folder" / "file", tmp_path):
        message = fails("render", "--mesh", good_mesh, option, str(place))
        assert str(place) in message, message


@pytest.mark.parametrize("option", ["--png", "--raw", "--depth"])
def test_an_older_output_outlives_an_error(fails: Fails, tmp_path: Path, option: str) -> None:
    path = tmp_path / "precious"
    path.write_bytes(b"older picture")
    fails("render", "--scene", "no-such-scene", option, str(path))
    assert path.read_bytes() == b"older picture"


@pytest.mark.parametrize("option", ["--png", "--raw", "--depth", "--wire"])
def test_a_full_disk_is_said_and_leaves_nothing(simulator: Simulator, tmp_path: Path, option: str) -> None:
    """A limit on files stands in for it; Python ignores its signal, which the program takes over."""
    limited = ["sh", "-c", 'ulimit -f 1; exec "$@"', "sh"]
    command = [*limited, str(simulator.path), "render", "--scene", "room", option, str(tmp_path / "out")]
    done = subprocess.run(command, restore_signals=False, capture_output=True, text=True, timeout=20, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"edgeline-sim: cannot write {tmp_path / 'out'}: File too large\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interruption_leaves_nothing_half_written(simulator: Simulator, tmp_path: Path, ending: int) -> None:
    (tmp_path / "out.png").write_bytes(b"older picture")
    names = ["--png", str(tmp_path / "out.png"), "--raw", str(tmp_path / "out.rgb"), "--threads", "2"]
    command = [str(simulator.path), "render", "--scene", "S1", "--frames", "1000000", *names]
    before = signal.signal(ending, signal.SIG_DFL)  # as a program inherits it where it is ignored
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as running:
        signal.signal(ending, before)
        deadline = time.monotonic() + 20
        while len(list(tmp_path.iterdir())) < 3 and time.monotonic() < deadline:
            time.sleep(0.01)
        running.send_signal(ending)
        assert running.communicate(timeout=20)[1] == ""
    assert running.returncode == -ending
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"older picture"]


COVERAGE = b"HOC1" + struct.pack("<4i", 1, 320, 240, 16) + struct.pack("<6i", 0, 0, 99, 0, 0, 99)
ATTRIBUTES = (
    b"HOA1" + struct.pack("<2i", 1, 1) + struct.pack("<2i2H2h4B", *([0] * 10)) * 3 + struct.pack("<3i", 0, 0, 0)
)

BAD_FILES = {
    "coverage empty": ("coverage", b""),
    "coverage of another kind": ("coverage", ATTRIBUTES),
    "coverage cut in the header": ("coverage", COVERAGE[:11]),
    "coverage cut in a triangle": ("coverage", COVERAGE[:-1]),
    "coverage count negative": ("coverage", COVERAGE[:4] + struct.pack("<i", -1) + COVERAGE[8:]),
    "coverage count huge": ("coverage", COVERAGE[:4] + struct.pack("<i", 0x7FFFFFFF) + COVERAGE[8:]),
    "coverage width zero": ("coverage", COVERAGE[:8] + struct.pack("<i", 0) + COVERAGE[12:]),
    "coverage height huge": ("coverage", COVERAGE[:12] + struct.pack("<i", 1 << 30) + COVERAGE[16:]),
    "coverage other subpixels": ("coverage", COVERAGE[:16] + struct.pack("<i", 3) + COVERAGE[20:]),
    "coverage beyond the guard band": ("coverage", COVERAGE[:20] + struct.pack("<i", 1 << 30) + COVERAGE[24:]),
    "attributes empty": ("attributes", b""),
    "attributes of another kind": ("attributes", COVERAGE),
    "attributes cut": ("attributes", ATTRIBUTES[:-1]),
    "attributes count negative": ("attributes", ATTRIBUTES[:4] + struct.pack("<i", -1) + ATTRIBUTES[8:]),
    "attributes count huge": ("attributes", ATTRIBUTES[:8] + struct.pack("<i", 0x7FFFFFFF) + ATTRIBUTES[12:]),
    "attributes of no such triangle": ("attributes", ATTRIBUTES[:-12] + struct.pack("<3i", 1, 0, 0)),
}


@pytest.mark.parametrize("case", BAD_FILES)
def test_bad_measurement_files(fails: Fails, tmp_path: Path, case: str) -> None:
    command, data = BAD_FILES[case]
    path = tmp_path / "question"
    path.write_bytes(data)
    fails(command, str(path), str(tmp_path / "out"))


@pytest.mark.parametrize("command", ["coverage", "attributes"])
def test_measurement_files_that_are_missing(fails: Fails, tmp_path: Path, command: str) -> None:
    assert "missing" in fails(command, str(tmp_path / "missing"), str(tmp_path / "out"))
    fails(command)
    fails(command, str(tmp_path / "missing"))


def test_bad_streams(fails: Fails) -> None:
    fails("stream", "--scene", "no-such-scene", "--stdout")
    fails("stream", "--tcp", "99999")
    fails("stream", "--tcp", "port")


def test_frames_that_nobody_keeps_are_told_of(simulator: Simulator, tmp_path: Path) -> None:
    done = simulator.run("render", "--scene", "solid", "--frames", "2")
    told = "edgeline-sim: render: 2 frames drawn and not kept; --png FILE keeps the last one, --help tells of others\n"
    assert (done.returncode, done.stdout, done.stderr) == (0, "", told)
    for kept in (["--crc"], ["--stats"], ["--png", str(tmp_path / "p.png")]):
        assert simulator.run("render", "--scene", "solid", *kept).stderr == ""
