"""INPUT from the command line and from `edgeline.open`: before START where the first frame has to show it, only to a
device that takes it."""

from __future__ import annotations

from pathlib import Path

import pytest

import edgeline as package
from conftest import Edgeline
from edgeline.errors import DeviceError, EdgelineError
from edgeline.protocol import Control, Input, Ping, Start
from edgeline.session import Frame, Refused, Session, State
from fake_device import FakeDevice, PtyDevice
from talk import Talk


def inputs_and_starts(device: FakeDevice) -> list[Input | Start]:
    return [body for body in device.commands if isinstance(body, Input | Start)]


def test_controls_that_are_set_early_go_ahead_of_start() -> None:
    talk = Talk()
    talk.session.input(Control.FRAME, 5)
    talk.session.input(Control.SCENE, 2)
    talk.session.input(Control.FRAME, 9)
    talk.run(5)
    assert inputs_and_starts(talk.device) == [Input(1, 2), Input(2, 9), Start(2)]
    assert len(talk.frames) > 3


def test_controls_that_are_set_later_go_at_once() -> None:
    talk = Talk()
    talk.run(5)
    talk.session.input(Control.PAUSE, 1)
    talk.session.input(200, -(2**31))
    talk.step()
    assert inputs_and_starts(talk.device) == [Start(2), Input(3, 1), Input(200, -(2**31))]


def test_a_device_that_was_started_anew_is_told_again() -> None:
    talk = Talk()
    talk.session.input(Control.SCENE, 2)
    talk.run(5)
    talk.session.input(Control.PAUSE, 1)
    talk.run(5)
    talk.device.commands.clear()
    talk.device.reboot(99, talk.now)
    talk.run(5)
    assert inputs_and_starts(talk.device) == [Input(1, 2), Input(3, 1), Start(2)]


def test_silence_alone_repeats_no_control() -> None:
    talk = Talk()
    talk.session.input(Control.FRAME, 7)
    talk.run(5)
    talk.device.limit = 0
    talk.run(200)
    assert inputs_and_starts(talk.device)[:2] == [Input(2, 7), Start(2)]
    assert set(inputs_and_starts(talk.device)[2:]) == {Start(2)}


def test_after_silence_a_scene_that_stands_still_is_told_again() -> None:
    talk = Talk()
    talk.session.input(Control.FRAME, 7)
    talk.session.input(Control.PAUSE, 1)
    talk.run(5)
    talk.device.commands.clear()
    talk.device.limit = 0
    talk.run(200)
    assert inputs_and_starts(talk.device)[:3] == [Input(2, 7), Input(3, 1), Start(2)]


def test_a_device_that_takes_no_input_gets_none() -> None:
    early = Talk(FakeDevice(takes_input=False))
    early.session.input(Control.SCENE, 2)
    refusals = [event for event in early.run(20) if isinstance(event, Refused)]
    assert [str(refusal.error) for refusal in refusals] == [
        "fake board, edgeline 0.1.0: takes no INPUT, so its scene cannot be chosen"
    ]
    assert early.session.state is State.REFUSED

    late = Talk(FakeDevice(takes_input=False))
    late.run(5)
    with pytest.raises(DeviceError, match="takes no INPUT"):
        late.session.input(Control.SCENE, 2)
    assert isinstance(late.run(5)[-1], Frame)
    for device in (early.device, late.device):
        assert not [body for body in device.commands if isinstance(body, Input)]
    assert {type(body) for body in early.device.commands} == {Ping}


@pytest.mark.parametrize(("control", "value"), [(-1, 0), (256, 0), (1, 2**31), (1, -(2**31) - 1)])
def test_numbers_that_do_not_fit_are_refused(control: int, value: int) -> None:
    with pytest.raises(EdgelineError, match="signed 32-bit"):
        Session().input(control, value)


def test_the_library_names_controls() -> None:
    device = FakeDevice()
    with PtyDevice(device) as served, package.open(served.port) as link:
        link.control("scene", 3)
        link.control("pause", 1)
        next(iter(link))
        with pytest.raises(EdgelineError, match="no control 'zoom'"):
            link.control("zoom", 1)
    assert inputs_and_starts(device)[:3] == [Input(1, 3), Input(3, 1), Start(2)]


def test_the_commands_set_controls(edgeline: Edgeline, tmp_path: Path) -> None:
    device = FakeDevice()
    with PtyDevice(device) as served:
        shot = edgeline("shot", "-p", served.port, "--scene", "4", "--frame", "0", "--pause")
        record = edgeline("record", "-p", served.port, "--frames", "1", "-o", "a.png", "--frame", "10")
    assert (shot.returncode, record.returncode) == (0, 0)
    assert inputs_and_starts(device) == [Input(1, 4), Input(2, 0), Input(3, 1), Start(2), Input(2, 10), Start(2)]
    assert {path.name for path in tmp_path.iterdir()} == {"shot.png", "a.png"}


def test_the_commands_say_when_there_is_no_input(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice(takes_input=False)) as served:
        shot = edgeline("shot", "-p", served.port, "--scene", "4")
        plain = edgeline("shot", "-p", served.port)
    assert shot.returncode == 3
    assert shot.stderr == (
        f"edgeline: {served.port}: fake board, edgeline 0.1.0: takes no INPUT, so its scene cannot be chosen\n"
    )
    assert plain.returncode == 0
    assert edgeline("shot", "--scene", "-1").returncode == 2
