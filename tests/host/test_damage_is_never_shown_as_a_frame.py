"""Seeded faults of every kind: each frame that comes out is the picture that went in, and the stream goes on."""

from __future__ import annotations

import numpy as np
import pytest

from edgeline.session import Damage, Frame
from fake_device import FakeDevice, Faults
from talk import Talk

KINDS = ["flip", "drop", "cut", "duplicate", "swap", "noise"]


def check(talk: Talk, steps: int) -> None:
    talk.run(steps)
    for frame in talk.frames:
        assert np.array_equal(frame.picture, talk.device.sent[frame.number]), f"frame {frame.number}"


def device(seed: int, faults: Faults) -> FakeDevice:
    """One of each kind by turns: runs, raw bands, codec 2 with segments that are left out."""
    if seed % 3 == 2:
        return FakeDevice(80, 16, split=True, faults=faults)
    return FakeDevice(runs=seed % 3 == 0, faults=faults)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("rate", [0.01, 0.1, 0.5])
@pytest.mark.parametrize("kind", KINDS)
def test_one_kind_of_fault(kind: str, rate: float, seed: int) -> None:
    talk = Talk(device(seed, Faults(seed, **{kind: rate})))  # type: ignore[arg-type]
    check(talk, 200)
    assert talk.device.faults.hits > 0
    assert any(isinstance(event, Damage) for event in talk.events)
    talk.device.faults = Faults()
    before = len(talk.frames)
    check(talk, 200)
    assert len(talk.frames) - before > 100, "the stream does not recover"


@pytest.mark.parametrize("seed", range(9))
def test_all_faults_together(seed: int) -> None:
    faults = Faults(seed, flip=0.03, drop=0.03, cut=0.03, duplicate=0.03, swap=0.03, noise=0.03)
    talk = Talk(device(seed, faults))
    check(talk, 400)
    assert faults.hits > 100
    assert len(talk.frames) > 30


@pytest.mark.parametrize("seed", range(6))
def test_what_the_host_says_is_damaged_too(seed: int) -> None:
    talk = Talk(FakeDevice(faults=Faults(seed, flip=0.05)))
    upward = Faults(seed + 100, flip=0.1, drop=0.1)
    receive = talk.device.receive
    talk.device.receive = lambda data, now, rate: receive(upward.apply(data) if data else data, now, rate)  # type: ignore[method-assign]
    check(talk, 800)
    assert len(talk.frames) > 30


def test_reboots_in_the_middle_of_frames() -> None:
    talk = Talk()
    for boot in range(20):
        talk.run(7 + boot)
        talk.device.sent.clear()
        seen = len(talk.frames)
        talk.device.reboot(boot + 1, talk.now)
        talk.run(30)
        fresh = talk.frames[seen:]
        assert len(fresh) > 15
        assert all(np.array_equal(frame.picture, talk.device.sent[frame.number]) for frame in fresh)


def test_recovery_takes_few_frames() -> None:
    """After one damaged band the stream is exact again within the frames that were on their way."""
    for packet in range(6, 40):
        talk = Talk(FakeDevice(faults=Faults(flip=1.0, first=packet, last=packet + 1)))
        talk.run(25)
        numbers = [frame.number for frame in talk.frames]
        missing = set(range(numbers[-1])) - set(numbers)
        assert len(missing) <= 2, f"packet {packet}: {missing}"
        assert isinstance(talk.events[-1], Frame)
