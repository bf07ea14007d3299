"""The conversations that are held: each kind of fault by itself, then together, in both modes and with both codecs.

The mean recovery that is promised, MEAN_RECOVERY, is for mode BLOCK, up to bit errors of 1e-5, and for pictures whose
frames are often whole at that rate. In ROLL a picture is built up over several frames, in which nothing can be proven.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypedDict

from channel import KINDS, Faults
from conversation import Case
from device import Boot
from edgeline.protocol import Mode

MEAN_RECOVERY = 5.0

RATE = 3_000_000
SMALL = Boot(scene="solid", width=64, height=48, rate=RATE, max_rate=RATE, render_us=8000)
TEXTURED = Boot(scene="room", width=64, height=48, rate=RATE, max_rate=RATE, render_us=8000)
COLOURS = Boot(scene="teapot", width=96, height=64, rate=RATE, max_rate=RATE, render_us=8000)
LARGE = Boot(scene="solid", width=320, height=240, band_lines=16, rate=RATE, max_rate=RATE, render_us=20000)
ROOM = Boot(scene="room", width=320, height=240, band_lines=16, rate=RATE, max_rate=RATE, render_us=20000)
"""60 KB a frame: at 1e-5 there are five wrong bits in each."""

MEDIUM = Boot(scene="teapot", width=160, height=120, band_lines=12, rate=RATE, max_rate=RATE, render_us=10000)
LINES = Boot(scene="field", width=100, height=40, rate=RATE, max_rate=RATE, render_us=8000, segments=False)
CHANGING = Boot(scene="solid", max_rate=921_600)
"""Begins at 115,200 baud and can be asked for more."""

SLOW = Boot(scene="room", width=96, height=64, rate=230_400, render_us=8000, ring=2048)
"""What cannot carry whole frames: ROLL has to leave lines out."""

SLOW_FLAT = Boot(scene="solid", width=64, height=48, rate=115_200, render_us=8000, ring=2048)
"""The same with a picture that can get through at 1e-4."""

MIXED = Faults(dropped=0.03, doubled=0.03, swapped=0.03, inserted=0.03, cut=0.03, bursts=0.03, garbage=0.03)


class _Both(TypedDict):
    """Of a Case: a kind of fault in both directions."""

    down: Faults
    up: Faults


def _often(down: Faults) -> _Both:
    """The host says little, so what it says is hit more often."""
    return {"down": down, "up": replace(down, **{kind: 5 * getattr(down, kind) for kind in KINDS})}


def _bits(rate: float) -> _Both:
    return {"down": Faults(rate), "up": Faults(rate)}


CASES = (
    Case("no faults", SMALL, inputs=0.2, recovery=0),
    Case("no faults, 320x240", LARGE, inputs=0.2, recovery=0, share=0.1),
    Case("no faults, ROLL", SLOW, mode=Mode.ROLL, inputs=0.2),
    Case("bit errors 1e-6, flat", SMALL, **_bits(1e-6), recovery=MEAN_RECOVERY),
    Case("bit errors 1e-6, vertex colours", COLOURS, **_bits(1e-6), recovery=MEAN_RECOVERY),
    Case("bit errors 1e-6, textured", TEXTURED, **_bits(1e-6)),
    Case("bit errors 1e-5, flat", SMALL, **_bits(1e-5), inputs=0.1, recovery=MEAN_RECOVERY),
    Case("bit errors 1e-5, vertex colours", COLOURS, **_bits(1e-5), inputs=0.1, recovery=MEAN_RECOVERY),
    Case("bit errors 1e-5, vertex colours, 160x120", MEDIUM, **_bits(1e-5), recovery=MEAN_RECOVERY, share=0.5),
    Case("bit errors 1e-5, textured", TEXTURED, **_bits(1e-5)),
    Case("bit errors 1e-5, runs", SMALL, **_bits(1e-5), split=False, recovery=MEAN_RECOVERY),
    Case("bit errors 1e-5, lines", LINES, **_bits(1e-5)),
    Case("bit errors 1e-5, ROLL", SLOW, **_bits(1e-5), mode=Mode.ROLL, inputs=0.1),
    Case("bit errors 1e-5, ROLL, flat", SLOW_FLAT, **_bits(1e-5), mode=Mode.ROLL, recovery=MEAN_RECOVERY, share=0.5),
    Case("bit errors 1e-5, 320x240", LARGE, **_bits(1e-5), recovery=MEAN_RECOVERY, share=0.1),
    Case("bit errors 1e-6, 320x240, textured", ROOM, **_bits(1e-6), share=0.05),
    Case("bit errors 1e-5, 320x240, textured", ROOM, **_bits(1e-5), share=0.002, patience_s=120),
    Case("bit errors 1e-4, flat", SMALL, **_bits(1e-4), inputs=0.1),
    Case("bit errors 1e-4, vertex colours", COLOURS, **_bits(1e-4), inputs=0.1, share=0.5),
    Case("bit errors 1e-4, runs", LINES, **_bits(1e-4), split=False),
    Case("bit errors 1e-4, ROLL", SLOW_FLAT, **_bits(1e-4), mode=Mode.ROLL, share=0.3),
    Case("bit errors 1e-4, 320x240", LARGE, **_bits(1e-4), share=0.02, patience_s=10),
    Case("bytes dropped", SMALL, **_often(Faults(dropped=0.1)), inputs=0.1),
    Case("bytes doubled", COLOURS, **_often(Faults(doubled=0.1)), inputs=0.1),
    Case("bytes reordered", TEXTURED, **_often(Faults(swapped=0.1)), inputs=0.1),
    Case("bytes inserted", LINES, **_often(Faults(inserted=0.1)), inputs=0.1),
    Case("packets cut", SMALL, **_often(Faults(cut=0.1)), inputs=0.1),
    Case("256 bytes lost", COLOURS, Faults(bursts=0.1), Faults(bursts=1, burst_bytes=20), inputs=0.1),
    Case("256 bytes lost, ROLL", SLOW, Faults(bursts=0.1), mode=Mode.ROLL),
    Case("garbage", SMALL, **_often(Faults(garbage=0.2)), inputs=0.1),
    Case("device resets", COLOURS, resets=0.02),
    Case("device resets, mixed faults", SMALL, MIXED, MIXED, resets=0.01),
    Case("late host", TEXTURED, late_s=7.0),
    Case("host stops reading", SMALL, pauses=0.01, inputs=0.05),
    Case("host stops reading, ROLL", SLOW, mode=Mode.ROLL, pauses=0.01),
    Case("a higher rate", CHANGING, MIXED, MIXED, fast=921_600, inputs=0.05),
    Case("a higher rate, resets", CHANGING, fast=921_600, resets=0.003),
    Case("everything", TEXTURED, MIXED, MIXED, resets=0.005, pauses=0.003),
    Case("everything, runs, ROLL", LINES, MIXED, MIXED, Mode.ROLL, False, resets=0.005, pauses=0.003),
)
