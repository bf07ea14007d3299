"""Seeded faults of every kind: each frame that comes out is the picture that went in, and the stream goes on."""

from __future__ import annotations

import numpy as np
import pytest

from edgeline.session import Damage, Frame
from fake_device import FakeDevice, Faults
from talk import Talk

KINDS = ["flip", "drop", "cut", "duplicate", "noise"]


def check(talk: Talk, steps: int) -> None:
    talk.run(steps)
    for frame in talk.frames:
        assert np.array_equal(frame.picture, talk.device.sent[frame.number]), f"frame {frame.number}"


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("rate", [0.01, 0.1, 0.5])
@pytest.mark.parametrize("kind", KINDS)
def test_one_kind_of_fault(kind: str, rate: float, seed: int) -> None:
    talk = Talk(FakeDevice(faults=Faults(seed, **{kind: rate})))  # type: ignore[arg-type]
    check(talk, 700)
    assert talk.device.faults.hits > 0
    assert any(isinstance(event, Damage) for event in talk.events)
    talk.device.faults = Faults()
    before = len(talk.frames)
    check(talk, 1000)
    assert len(talk.frames) - before > 100, "the stream does not recover"


@pytest.mark.parametrize("seed", range(10))
def test_all_faults_together(seed: int) -> None:
    faults = Faults(seed, flip=0.03, drop=0.03, cut=0.03, duplicate=0.03, noise=0.03)
    talk = Talk(FakeDevice(faults=faults, runs=seed % 2 == 0))
    check(talk, 1500)
    assert faults.hits > 100
    assert len(talk.frames) > 30


@pytest.mark.parametrize("seed", range(6))
def test_what_the_host_says_is_damaged_too(seed: int) -> None:
    talk = Talk(FakeDevice(faults=Faults(seed, flip=0.05)))
    upward = Faults(seed + 100, flip=0.1, drop=0.1)
    receive = talk.device.receive
    talk.device.receive = lambda data, now: receive(upward.apply(data) if data else data, now)  # type: ignore[method-assign]
    check(talk, 3000)
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
        talk.run(60)
        numbers = [frame.number for frame in talk.frames]
        missing = set(range(numbers[-1])) - set(numbers)
        assert len(missing) <= 2, f"packet {packet}: {missing}"
        assert isinstance(talk.events[-1], Frame)
