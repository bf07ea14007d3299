"""The simulator's stream, recorded, cut, replayed and verified: the digests are those of what `render` draws.

Needs the environment variable EDGELINE_SIM, the path of edgeline-sim. Skipped without it, a failure in CI.
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from edgeline import golden
from edgeline.cli import main
from edgeline.codec import PIXEL
from edgeline.golden import Golden, Place
from edgeline.picture import digest_of
from recorded import frames_of
from test_replay_is_a_device import replaying
from test_simulator_and_host_agree import streaming

WIDTH, HEIGHT, FRAMES = 320, 240, 8
SCENE = "teapot"


@pytest.fixture(scope="module")
def digests(simulator: str, tmp_path_factory: pytest.TempPathFactory) -> list[int]:
    """Of the scene's first frames, as `render` draws them."""
    raw = tmp_path_factory.mktemp("truth") / "frames.rgb565"
    command = [simulator, "render", "--scene", SCENE, "--frames", str(FRAMES), "--raw", str(raw)]
    subprocess.run(command, check=True, timeout=60)
    return [digest_of(picture) for picture in np.fromfile(raw, PIXEL).reshape(FRAMES, HEIGHT, WIDTH)]


@pytest.fixture(scope="module")
def folder(simulator: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a recording of the scene, a.elrec."""
    made = tmp_path_factory.mktemp("recorded")
    with streaming(simulator, SCENE, "--pty") as port:
        assert main(["record", "-p", port, "--frames", str(FRAMES), "-o", str(made / "a.elrec")]) == 0
    return made


def test_a_recording_has_the_rendered_frames(folder: Path, digests: list[int]) -> None:
    assert [frame.end.digest for _, frame in frames_of(folder / "a.elrec")] == digests


@pytest.mark.parametrize("link", ["file", "pty", "tcp"])
def test_it_is_viewed_with_the_same_digests(
    link: str, folder: Path, digests: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    viewing = ["view", "--headless", "--digests", "--json", "--frames", str(FRAMES), "-p"]
    if link == "file":
        assert main([*viewing, str(folder / "a.elrec")]) == 0
    else:
        with replaying(folder, "--as-fast", *(["--pty"] if link == "pty" else ["--tcp", "0"])) as (port, _):
            assert main([*viewing, port]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["digests"] == [f"{digest:08x}" for digest in digests]
    assert told["damaged"] == 0


def test_a_cut_of_it_is_viewed_with_the_same_digests(folder: Path, digests: list[int]) -> None:
    times = [time_s for time_s, _ in frames_of(folder / "a.elrec")]
    arguments = ["--from", f"{times[2]:.6f}", "--to", f"{times[6]:.6f}", "-o", str(folder / "b.elrec")]
    assert main(["cut", str(folder / "a.elrec"), *arguments]) == 0
    cut = [frame.end.digest for _, frame in frames_of(folder / "b.elrec")]
    assert 0 < len(cut) <= 4
    assert "".join(map(str, cut)) in "".join(map(str, digests))


def test_the_simulator_conforms(
    simulator: str, folder: Path, digests: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    """A golden file of what `render` draws; then one with a wrong line in it."""
    listed = subprocess.run([simulator, "list"], capture_output=True, text=True, check=True, timeout=20).stdout
    scene = [line.split()[0] for line in listed.splitlines()].index(SCENE)
    goldens = [Golden(Place(scene, frame), WIDTH, HEIGHT, digest) for frame, digest in enumerate(digests)]
    path = folder / "golden.crc"
    golden.write(str(path), goldens[::-1])
    with streaming(simulator, "demo", "--pty") as port:
        assert main(["verify", str(path), "-p", port, "--record", str(folder / "evidence.elrec")]) == 0
    assert main(["verify", str(path), "-p", str(folder / "evidence.elrec")]) == 0
    golden.write(str(path), [*goldens[:3], Golden(Place(scene, 3), WIDTH, HEIGHT, digests[4])])
    capsys.readouterr()
    assert main(["verify", str(path), "-p", str(folder / "evidence.elrec")]) == 1
    assert f"{digests[4]:08x}  {digests[3]:08x}  differs" in capsys.readouterr().out
