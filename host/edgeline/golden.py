"""golden.crc: which picture a device has to show at which frame of which scene, as digests.

A text file, a line per picture: `scene frame width height digest`, the digest as eight hexadecimal digits; empty lines
and what follows a # are remarks. The scene is its number, and the frame the scene's own; with `-` for the scene, the
frame is the wire's number, for a device that takes no INPUT and simply plays.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from edgeline.errors import EdgelineError
from edgeline.outfile import AtomicFile, cannot_write
from edgeline.protocol import MAX_SIDE, Control, Input

LARGEST_FILE = 16 << 20
_LINE = re.compile(r"(-|\d{1,10})\s+(\d{1,10})\s+(\d{1,4})\s+(\d{1,4})\s+([0-9a-fA-F]{8})", re.ASCII)
_HEADING = "# scene frame width height digest (edgeline verify --update)\n"
_LARGEST_NUMBER = (1 << 31) - 1
_NUMBERS_AHEAD = 128
"""A number within so many after the last one is a later INPUT, another one an earlier one sent again."""


@dataclass(frozen=True)
class Place:
    """A picture's place: `frame` of `scene`, or the wire's frame number if `scene` is None."""

    scene: int | None
    frame: int

    def __str__(self) -> str:
        return f"{'-' if self.scene is None else self.scene} {self.frame}"


@dataclass(frozen=True)
class Golden:
    """The picture that has to be at a place."""

    place: Place
    width: int
    height: int
    digest: int

    def __str__(self) -> str:
        return f"{self.place} {self.width} {self.height} {self.digest:08x}"


def read(path: str) -> list[Golden]:
    """The lines of a golden file, in its order. Raises EdgelineError with the line that is wrong."""
    try:
        with Path(path).open("rb") as stream:
            raw = stream.read(LARGEST_FILE + 1)
    except OSError as error:
        hint = "; --update makes it" if isinstance(error, FileNotFoundError) else ""
        raise EdgelineError(f"{path}: cannot be read: {error.strerror or error}{hint}") from None
    if len(raw) > LARGEST_FILE:
        raise EdgelineError(f"{path}: is larger than {LARGEST_FILE >> 20} MB, so it is no golden file")
    goldens: dict[Place, Golden] = {}
    for number, line in enumerate(raw.decode("utf-8", "replace").splitlines(), start=1):
        content = line.partition("#")[0].strip()
        if not content:
            continue
        golden = _parse(content)
        if golden is None:
            expected = "`scene frame width height digest`"
            raise EdgelineError(f"{path}, line {number}: expected {expected}, found: {content[:60]}")
        if golden.place in goldens:
            raise EdgelineError(f"{path}, line {number}: scene and frame {golden.place} stand there twice")
        goldens[golden.place] = golden
    if not goldens:
        raise EdgelineError(f"{path}: holds no pictures; --update makes it anew")
    return list(goldens.values())


def write(path: str, goldens: Iterable[Golden]) -> None:
    """Writes a golden file. Raises OutputError and leaves what was there."""
    file = AtomicFile(path)
    try:
        file.stream.write((_HEADING + "".join(f"{golden}\n" for golden in goldens)).encode())
        file.commit()
    except OSError as error:
        raise cannot_write(path, error) from None
    finally:
        file.discard()


def _parse(content: str) -> Golden | None:
    match = _LINE.fullmatch(content)
    if match is None:
        return None
    scene = None if match[1] == "-" else int(match[1])
    frame, width, height = int(match[2]), int(match[3]), int(match[4])
    fits = max(scene or 0, frame) <= _LARGEST_NUMBER and min(width, height) >= 1 and max(width, height) <= MAX_SIDE
    return Golden(Place(scene, frame), width, height, int(match[5], 16)) if fits else None


class Shown:
    """Which place a recorded device showed since its start, from the INPUTs that it was sent.

    Known is a scene that was chosen while it stood still, with camera, shading and view as the program has them.
    """

    def __init__(self) -> None:
        self._waiting: deque[Input] = deque()
        self._taken: int | None = None
        self._paused = False
        self._place: Place | None = None
        self._others: dict[int, int] = {}

    def told(self, body: Input) -> None:
        """The host sent this INPUT. It may do so again, until the device confirms it."""
        last = self._waiting[-1].number if self._waiting else self._taken
        if body.number is None or (last is not None and (body.number - last - 1) % 256 >= _NUMBERS_AHEAD):
            return
        if len(self._waiting) < _NUMBERS_AHEAD:
            self._waiting.append(body)

    def place(self, number: int, scenes: int) -> Place | None:
        """Where a frame is that FRAME_END gives this INPUT number, None: not known. `scenes`: HELLO's."""
        if any(body.number == number for body in self._waiting):
            while self._taken != number:
                body = self._waiting.popleft()
                self._taken = body.number
                self._take(body, scenes)
        self._taken = number
        as_made = all(value == _NEUTRAL.get(control, 0) for control, value in self._others.items())
        return self._place if self._paused and as_made else None

    def _take(self, body: Input, scenes: int) -> None:
        """As the device does; values that it does not know change nothing."""
        control, value, place = body.control, body.value, self._place
        if control == Control.PAUSE and value in (0, 1):
            self._paused = value == 1
            self._place = place if self._paused else None
        elif control == Control.SCENE and (0 <= value < scenes or (scenes == 0 and value >= 0)):
            self._place = Place(value, 0) if self._paused else None
        elif control == Control.FRAME and value >= 0:
            self._place = replace(place, frame=value) if place is not None else None
        elif control == Control.STEP and value > 0:
            self._place = replace(place, frame=place.frame + value) if place is not None else None
        elif control > Control.STEP:
            self._others[control] = value


_NEUTRAL: dict[int, int] = {Control.ANTIALIASING: 1}
"""The value that changes nothing, where it is not 0."""
