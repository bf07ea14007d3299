"""INPUT from the command line and from `edgeline.open`: before START where the first frame has to show it, only to a
device that takes it."""

from __future__ import annotations

import re
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
    assert inputs_and_starts(talk.device) == [Input(2, 5, 1), Input(1, 2, 2), Input(2, 9, 3), Start(2)]
    assert len(talk.frames) > 3
    assert all(frame.shows_inputs for frame in talk.frames)


def test_controls_that_are_set_later_go_at_once() -> None:
    talk = Talk()
    talk.run(5)
    talk.session.input(Control.PAUSE, 1)
    talk.session.input(200, -(2**31))
    talk.step()
    assert inputs_and_starts(talk.device) == [Start(2), Input(3, 1, 1), Input(200, -(2**31), 2)]


def test_a_device_that_was_started_anew_is_told_again_step_excepted() -> None:
    talk = Talk()
    talk.session.input(Control.SCENE, 2)
    talk.run(5)
    talk.session.input(Control.PAUSE, 1)
    talk.session.input(Control.STEP, 5)
    talk.session.input(Control.VIEW, 1)
    talk.session.input(Control.SCENE, 3)
    talk.run(5)
    talk.device.commands.clear()
    talk.device.reboot(99, talk.now)
    talk.run(5)
    assert inputs_and_starts(talk.device) == [Input(3, 1, 1), Input(13, 1, 2), Input(1, 3, 3), Start(2)]


def test_another_program_after_the_restart_is_told_what_it_knows() -> None:
    talk = Talk()
    talk.session.input(Control.SCENE, 2)
    talk.session.input(Control.VIEW, 1)
    talk.run(5)
    talk.device.commands.clear()
    talk.device.controls = 1 << Control.SCENE
    talk.device.reboot(99, talk.now)
    talk.run(5)
    assert inputs_and_starts(talk.device) == [Input(1, 2, 1), Start(2)]


def test_silence_repeats_no_control() -> None:
    talk = Talk()
    talk.session.input(Control.FRAME, 7)
    talk.session.input(Control.PAUSE, 1)
    talk.run(5)
    talk.device.limit = 0
    talk.run(200)
    assert talk.device.taken == [(2, 7), (3, 1)]
    assert inputs_and_starts(talk.device)[:3] == [Input(2, 7, 1), Input(3, 1, 2), Start(2)]
    assert set(inputs_and_starts(talk.device)[3:]) == {Start(2)}


def test_a_control_that_the_device_does_not_know_is_named() -> None:
    early = Talk(FakeDevice(controls=0b1110))
    early.session.input(Control.VIEW, 2)
    refusals = [event for event in early.run(20) if isinstance(event, Refused)]
    assert [str(refusal.error) for refusal in refusals] == ["fake board, edgeline 0.1.0: has no control VIEW"]
    late = Talk(FakeDevice(controls=0b1110))
    late.run(5)
    late.session.input(Control.PAUSE, 1)
    late.session.input(128, 1)
    for control, name in ((Control.VIEW, "VIEW"), (77, "77")):
        with pytest.raises(DeviceError, match=f"has no control {name}$"):
            late.session.input(control, 2)
    late.run(5)
    assert late.device.taken == [(3, 1), (128, 1)]


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
        assert next(iter(link)).shows_inputs
        link.control("pan_x", -7)
        link.control(200, 5)
        assert link.next_frame(settled=True).shows_inputs
        assert device.taken == [(1, 3), (3, 1), (8, -7), (200, 5)]
        with pytest.raises(EdgelineError, match=r"no control 'zoomed': there are scene, frame, .*, view; others have"):
            link.control("zoomed", 1)
    assert inputs_and_starts(device)[:3] == [Input(1, 3, 1), Input(3, 1, 2), Start(2)]


def test_the_commands_set_controls(edgeline: Edgeline, tmp_path: Path) -> None:
    device = FakeDevice()
    with PtyDevice(device) as served:
        shot = edgeline("shot", "-p", served.port, "--scene", "3", "--frame", "0", "--pause")
        record = edgeline("record", "-p", served.port, "--frames", "1", "-o", "a.png", "--frame", "10")
    assert (shot.returncode, record.returncode) == (0, 0)
    assert device.taken == [(3, 1), (1, 3), (2, 0), (2, 10)]
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


@pytest.mark.parametrize(
    ("control", "value", "said"),
    [
        ("scene", 4, "fake board, edgeline 0.1.0: has no scene 4: they are 0..3"),
        ("view", 9, "fake board, edgeline 0.1.0: has no debug view 9"),
        ("pitch", 16385, "PITCH 16385: it takes -16384..16384"),
        ("step", 0, "STEP 0: it takes 1..2147483647"),
    ],
)
def test_what_the_device_would_ignore_is_refused(control: str, value: int, said: str) -> None:
    """With and without its HELLO, which says what it has."""
    with PtyDevice(FakeDevice()) as served, package.open(served.port) as link:
        _ = link.hello
        with pytest.raises(DeviceError, match=re.escape(said)):
            link.control(control, value)
    with PtyDevice(FakeDevice()) as served, package.open(served.port) as link:
        link.control(control, value)
        with pytest.raises(DeviceError, match=re.escape(said)):
            link.next_frame(5)


def test_a_value_that_is_no_whole_number_is_refused() -> None:
    with PtyDevice(FakeDevice()) as served, package.open(served.port) as link:
        with pytest.raises(EdgelineError, match=r"a control is 0\.\.255, its value a signed 32-bit number"):
            link.control("scene", "room")  # type: ignore[arg-type]
        with pytest.raises(EdgelineError, match=r"a control is 0\.\.255"):
            link.control("pan_x", 1.5)  # type: ignore[arg-type]
