"""MP4 by the program ffmpeg, which is told raw frames on its standard input and nothing else.

H.264 keeps colour at half the picture's resolution, so each pixel becomes a square of four: every colour arrives, and
odd sizes become even ones. The frame rate is constant, 100/s, and a frame repeated until the next one is due: times are
whole 1/100 s whose rounding does not add up, and repeated frames take next to no room.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import tempfile
from typing import IO

from edgeline.codec import Pixels
from edgeline.colour import to_rgb
from edgeline.errors import OutputError
from edgeline.exports.animation import Animation, Ticks

FRAME_RATE = 100
_TICK_US = 1_000_000 // FRAME_RATE
_QUIT_S = 10.0
_LONGEST_COMPLAINT = 4096


def arguments(width: int, height: int, output: str) -> list[str]:
    """What ffmpeg is called with: frames of rgb24 on standard input, H.264 that every player knows in `output`."""
    return [
        *("-hide_banner", "-loglevel", "error", "-y"),
        *("-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", f"{width}x{height}"),
        *("-framerate", str(FRAME_RATE), "-i", "pipe:0"),
        *("-vf", "scale=2*iw:2*ih:flags=neighbor:out_color_matrix=bt709:out_range=tv,format=yuv420p"),
        *("-c:v", "libx264", "-preset", "medium", "-crf", "16"),
        *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"),
        *("-movflags", "+faststart", "-f", "mp4", f"file:{output}"),
    ]


class Mp4Recorder(Animation):
    """An MP4, written by ffmpeg; OutputError without it, or when it fails, says so in one line."""

    def __init__(self, path: str) -> None:
        self._program = shutil.which("ffmpeg")
        if self._program is None:
            raise OutputError(
                f"{path}: MP4 needs the program ffmpeg, which is not installed (apt, brew or winget install ffmpeg); "
                "*.gif and *.apng need nothing"
            )
        super().__init__(path)
        self._ticks = Ticks(_TICK_US, least=1)
        self._process: subprocess.Popen[bytes] | None = None
        self._complaints: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 (until `discard`)

    def _frame(self, picture: Pixels, duration_us: int) -> None:
        if self._process is None:
            self._process = self._run(picture.shape[1], picture.shape[0])
        frame = to_rgb(picture).tobytes()
        assert self._process.stdin is not None
        try:
            for _ in range(self._ticks.of(duration_us)):
                self._process.stdin.write(frame)
        except BrokenPipeError:
            raise self._failure(self._process) from None

    def _end(self) -> None:
        assert self._process is not None and self._process.stdin is not None
        try:
            self._process.stdin.close()
        except BrokenPipeError:
            raise self._failure(self._process) from None
        if self._process.wait() != 0:
            raise self._failure(self._process)

    def discard(self) -> None:
        if self._process is not None and self._process.poll() is None:
            self._process.kill()
            self._process.wait(_QUIT_S)
        if self._process is not None and self._process.stdin is not None:
            with contextlib.suppress(OSError):  # it was ffmpeg that closed it
                self._process.stdin.close()
        self._complaints.close()
        super().discard()

    def _run(self, width: int, height: int) -> subprocess.Popen[bytes]:
        assert self._program is not None
        return subprocess.Popen(
            [self._program, *arguments(width, height, self._file.name)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=self._complaints,
            # Ctrl+C ends the recording, not ffmpeg: it has frames to finish.
            start_new_session=os.name == "posix",
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )

    def _failure(self, process: subprocess.Popen[bytes]) -> OutputError:
        status = process.wait()
        self._complaints.seek(0)
        said = self._complaints.read(_LONGEST_COMPLAINT).decode(errors="replace").strip().splitlines()
        why = "".join(c if c.isprintable() else " " for c in said[-1]) if said else "without a word"
        return OutputError(f"{self._path}: ffmpeg ended with status {status}: {why}")
