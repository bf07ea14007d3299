"""Which pictures a device shows at the places of a golden file, and how they compare.

A device that takes INPUT is asked for each place; one that does not, a pipe or a recording is watched. In a recording
of a device that was asked, the recorded INPUTs tell the places, so it proves as much as the device did.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Protocol

import numpy as np

from edgeline.codec import PIXEL, Pixels
from edgeline.errors import DeviceError, EdgelineError, StreamEndError, StreamError, WireError
from edgeline.follow import follow
from edgeline.framing import Packet
from edgeline.golden import Golden, Place, Shown
from edgeline.link import Link
from edgeline.protocol import Capability, Control, Input, unpack
from edgeline.recording import Direction, RecordingReader, opened
from edgeline.session import Frame

Seen = tuple[Place, Frame]

RELEASE_S = 2.0
"""How long a device is waited for that is to go on."""


@dataclass(frozen=True)
class Verdict:
    """What became of one golden picture. `digest` is what the device showed, None if it did not show the place."""

    golden: Golden
    size: tuple[int, int] | None
    """width and height of what it showed"""
    digest: int | None

    @property
    def equal(self) -> bool:
        return self.digest == self.golden.digest and self.size == (self.golden.width, self.golden.height)

    @property
    def words(self) -> str:
        if self.digest is None or self.size is None:
            return "not shown"
        if self.size != (self.golden.width, self.golden.height):
            return f"is {self.size[0]}x{self.size[1]}"
        return "equal" if self.equal else "differs"


def judge(golden: Golden, frame: Frame | None) -> Verdict:
    """`frame` is what stood at the golden picture's place, None: nothing."""
    if frame is None:
        return Verdict(golden, None, None)
    height, width = frame.picture.shape
    return Verdict(golden, (width, height), frame.end.digest)


def golden_of(place: Place, frame: Frame) -> Golden:
    height, width = frame.picture.shape
    return Golden(place, width, height, frame.end.digest)


class Source(Protocol):
    """What shows pictures. Both give each place once at most, and raise StreamError when no frame comes in time."""

    def show(self, places: Collection[Place]) -> Iterator[Seen]:
        """The pictures at `places`, in any order; those that it does not have are left out."""

    def first(self, frames: int, scene: int | None) -> Iterator[Seen]:
        """What a golden file is made of: the first `frames` frames of `scene`, None: of each; where scenes cannot be
        told apart, simply the first."""


class Device:
    """On `link`. Asked for scenes' frames, which it needs INPUT for; watched for numbered ones."""

    def __init__(self, link: Link, timeout_s: float) -> None:
        self._link = link
        self._timeout_s = timeout_s
        self._paused = False

    def release(self) -> None:
        """Lets a device that was asked go on, as far as the link still holds."""
        if self._paused:
            with contextlib.suppress(StreamError):
                self._link.control(Control.PAUSE, 0)
                self._link.next_frame(RELEASE_S, settled=True)

    def show(self, places: Collection[Place]) -> Iterator[Seen]:
        asked = [place for place in places if place.scene is not None]
        if asked:
            yield from self._ask(asked)
        awaited = {place for place in places if place.scene is None}
        heard = time.monotonic()
        for place, frame in self._watch() if awaited else ():
            if place in awaited:
                awaited.discard(place)
                heard = time.monotonic()
                yield place, frame
            if not awaited or time.monotonic() - heard > self._timeout_s:
                return

    def first(self, frames: int, scene: int | None) -> Iterator[Seen]:
        if not self._can_be_asked:
            yield from islice(self._watch(), frames)
            return
        scenes = self._link.hello.scenes
        if scene is None and scenes == 0:
            raise EdgelineError(f"{self._link.transport.name}: does not say which scenes it has: name one with --scene")
        wanted = range(scenes) if scene is None else (scene,)
        yield from self._ask([Place(number, frame) for number in wanted for frame in range(frames)])

    @property
    def _can_be_asked(self) -> bool:
        needed = (Control.PAUSE, Control.SCENE, Control.FRAME)
        return not self._link.transport.one_way and all(self._link.hello.knows(control) for control in needed)

    def _ask(self, places: list[Place]) -> Iterator[Seen]:
        link = self._link
        if not self._can_be_asked:
            raise DeviceError(f"{link.transport.name}: takes no INPUT, so no scene's frame can be asked for")
        scenes = link.hello.scenes
        chosen: int | None = None
        link.control(Control.PAUSE, 1)
        self._paused = True
        for place in places:
            if place.scene is None or (scenes and place.scene >= scenes):
                continue
            if place.scene != chosen:
                chosen = place.scene
                link.control(Control.SCENE, chosen)
            link.control(Control.FRAME, place.frame)
            yield place, link.next_frame(self._timeout_s, settled=True)

    def _watch(self) -> Iterator[Seen]:
        while True:
            try:
                frame = self._link.next_frame(self._timeout_s, settled=True)
            except StreamEndError:
                return
            yield Place(None, frame.number), frame


class RecordedDevice:
    """In the recording `path`. A frame's place is its number and, where recorded INPUTs tell it, a scene's frame."""

    def __init__(self, path: str) -> None:
        self._path = path

    def show(self, places: Collection[Place]) -> Iterator[Seen]:
        awaited = set(places)
        for place, frame in self._watch():
            if place in awaited:
                awaited.discard(place)
                yield place, frame

    def first(self, frames: int, scene: int | None) -> Iterator[Seen]:
        by_scene = any(place.scene is not None for place, _ in self._watch())
        taken: set[Place] = set()
        for place, frame in self._watch():
            if (place.scene is not None) is not by_scene or place in taken:
                continue
            belongs = place.frame < frames and scene in (None, place.scene) if by_scene else len(taken) < frames
            if belongs:
                taken.add(place)
                yield place, frame

    def _watch(self) -> Iterator[Seen]:
        with opened(self._path) as reader:
            yield from _places(reader)


def side_by_side(expected: Pixels | None, picture: Pixels) -> Pixels:
    """For people to look at: what was expected, what came, and the pixels that differ, white on a dark copy; only what
    came where nothing of its size is expected."""
    if expected is None or expected.shape != picture.shape:
        return picture
    dark = (expected >> 2 & 0x39E7).astype(PIXEL)  # every channel at a quarter
    difference = np.where(expected != picture, PIXEL.type(0xFFFF), dark)
    gap = np.zeros((picture.shape[0], 4), PIXEL)
    return np.hstack((expected, gap, picture, gap, difference)).astype(PIXEL)


def _places(reader: RecordingReader) -> Iterator[Seen]:
    shown = Shown()
    boot_id: int | None = None
    for step in follow(reader):
        if step.hello is not None and step.hello.boot_id != boot_id:
            boot_id = step.hello.boot_id
            shown = Shown()
        if step.piece.direction is Direction.TO_DEVICE:
            body = _input(step.chunk) if isinstance(step.chunk, Packet) else None
            if body is not None:
                shown.told(body)
        elif step.frame is not None and step.hello is not None and not step.frame.mixed:
            yield Place(None, step.frame.number), step.frame
            if step.hello.numbers_inputs and Capability.INPUT in step.hello.capabilities:
                place = shown.place(step.frame.end.input, step.hello.scenes)
                if place is not None:
                    yield place, step.frame


def _input(packet: Packet) -> Input | None:
    try:
        body = unpack(packet)
    except (WireError, DeviceError):
        return None
    return body if isinstance(body, Input) else None
