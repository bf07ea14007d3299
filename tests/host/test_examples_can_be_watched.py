"""A program of firmware/examples/programs that runs with --pty: the host sees its frames, and keys that are typed where
it was started change them.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np

import edgeline as package

FRAMES_TO_WAIT = 60
"""Until a key must have been taken."""


def test_keys_change_what_the_host_sees(simulator: str, tmp_path: Path) -> None:
    program = str(Path(simulator).parent / "examples" / "textured_room")
    before, after = (picture_of(program, keys, tmp_path) for keys in (".", ".w"))
    process = subprocess.Popen([program, "--pty"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdin is not None and process.stdout is not None
    try:
        with package.open(process.stdout.readline().strip()) as link:
            frames = iter(link)
            np.testing.assert_array_equal(next(frames).rgb565, before)
            process.stdin.write("w")
            process.stdin.flush()
            assert any(np.array_equal(next(frames).rgb565, after) for _ in range(FRAMES_TO_WAIT))
    finally:
        process.terminate()
        process.stdin.close()
        process.stdout.close()
    assert process.wait(10) == 0


def picture_of(program: str, keys: str, folder: Path) -> np.ndarray:
    """The last of the frames that have these keys."""
    raw = folder / "frames.rgb565"
    subprocess.run([program, "--frames", str(len(keys)), "--keys", keys, "--raw", str(raw)], check=True, timeout=60)
    return np.fromfile(raw, "<u2").reshape(len(keys), 240, 320)[-1]
