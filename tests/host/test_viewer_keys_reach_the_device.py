"""Keys and the mouse: each does what the help says, reaches the device in order, and never floods it."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest

from edgeline.protocol import Capability, Control, DebugView, Hello
from edgeline.session import Session
from edgeline.viewer import legend
from edgeline.viewer.controls import ORBIT_PER_PIXEL, ORBIT_STEP, Controls
from edgeline.viewer.keys import HELP, Action, bindings
from fake_device import ALL_CONTROLS, ALL_VIEWS, FakeDevice, PtyDevice
from viewer_at_work import AtWork, at_work

FIRMWARE = Path(__file__).parents[2] / "firmware"


def hello(controls: int = ALL_CONTROLS, views: int = ALL_VIEWS, scenes: int = 3) -> Hello:
    offered = Capability.RAW | Capability.INPUT
    return Hello(8, 8, offered, 1, "board", "firmware", minor=2, scenes=scenes, controls=controls, views=views)


def connected(**device: int) -> Controls:
    controls = Controls()
    controls.connect(hello(**device), one_way=False)
    return controls


def taken(controls: Controls) -> list[tuple[Control, int]]:
    return list(iter(controls.take, None))


def test_every_action_has_a_key_and_no_key_has_two_actions() -> None:
    bound = list(bindings())
    assert {action for _, action, _ in bound} == set(Action)
    patterns = [pattern for pattern, _, _ in bound]
    assert len(patterns) == len(set(patterns))
    assert all(key.shown and key.does for _, keys in HELP for key in keys)


def test_the_box_keeps_the_newest_value_of_each_control() -> None:
    controls = connected()
    for _ in range(100):
        controls.turn(ORBIT_STEP, 10)
    controls.approach(3)
    assert taken(controls) == [(Control.YAW, 100 * ORBIT_STEP & 0xFFFF), (Control.PITCH, 1000), (Control.ZOOM, 96)]
    assert taken(controls) == []
    controls.pause(True)
    for _ in range(5):
        controls.step()
    assert taken(controls) == [(Control.PAUSE, 1), (Control.STEP, 5)]


def test_another_link_is_told_all_that_was_set() -> None:
    controls = connected()
    controls.next_view(1)
    controls.choose_scene(2)
    controls.turn(ORBIT_STEP, 0)
    taken(controls)
    controls.connect(hello(), one_way=False)
    assert taken(controls) == []
    controls.connect(hello(), one_way=False, again=True)
    view = (Control.VIEW, int(DebugView.OVERDRAW))
    assert taken(controls) == [(Control.PAUSE, 0), (Control.SCENE, 2), (Control.YAW, ORBIT_STEP), view]


def test_values_stay_in_the_wire_s_ranges() -> None:
    controls = connected()
    for _ in range(200):
        controls.turn(-ORBIT_STEP, -ORBIT_STEP)
        controls.approach(-1)
        controls.move(100, -100)
    assert dict(taken(controls)) == {
        Control.YAW: -200 * ORBIT_STEP & 0xFFFF,
        Control.PITCH: -16384,
        Control.ZOOM: -1024,
        Control.PAN_X: 4096,
        Control.PAN_Y: -4096,
    }
    controls.reset_camera()
    assert set(taken(controls)) == {(control, 0) for control in map(Control, range(Control.YAW, Control.PAN_Y + 1))}


def test_choices_go_around() -> None:
    controls = connected(views=1 << DebugView.PICTURE | 1 << DebugView.DEPTH)
    seen = []
    for _ in range(4):
        controls.next_scene(1)
        controls.next_shading()
        controls.next_antialiasing()
        controls.next_view(1)
        controls.next_texture_error()
        seen.append([value for _, value in taken(controls)])
    assert seen == [[0, 1, 4, 2, 1], [1, 2, 8, 0, 2], [2, 3, 1, 2, 3], [0, 0, 4, 0, 4]]
    controls.choose_scene(7)  # there are three
    assert taken(controls) == []
    unknown = connected()
    unknown.next_scene(-1)
    assert taken(unknown) == [(Control.SCENE, 2)]


def test_a_device_is_asked_for_nothing_that_it_does_not_know() -> None:
    for controls in (connected(controls=1 << Control.SCENE), Controls()):
        controls.turn(1, 1)
        controls.approach(1)
        controls.move(1, 1)
        controls.step()
        controls.pause(True)
        controls.next_view(1)
        assert taken(controls) == []
    one_way = Controls()
    one_way.connect(hello(), one_way=True)
    one_way.choose_scene(1)
    assert taken(one_way) == []


def test_a_view_that_another_device_lacks_is_left() -> None:
    controls = connected()
    controls.next_view(1)
    controls.connect(hello(views=1), one_way=False)
    assert controls.view is DebugView.PICTURE
    controls.next_view(1)
    assert controls.view is DebugView.PICTURE


def test_the_legend_has_the_firmware_s_colours() -> None:
    source = (FIRMWARE / "src/frame/debug_view.c").read_text(encoding="utf-8")
    table = re.search(r"el_debug_heat\[EL_DEBUG_HEATS\] = \{(.*?)\}", source, re.DOTALL)
    assert table is not None
    assert tuple(int(value, 16) for value in re.findall(r"0x[0-9A-F]{4}", table[1])) == legend.HEATS
    near = re.search(r"NEAR_GREY = (\d+)", source)
    greys = re.search(r"GREYS = 255 - (\d+)", source)
    assert near is not None
    assert greys is not None
    assert (legend.GREYS[0], legend.GREYS[-1]) == (int(near[1]), int(greys[1]))


def wait_for_input(viewer: AtWork, device: FakeDevice, expected: list[tuple[Control, int]]) -> None:
    viewer.until(lambda: len(device.taken) >= len(expected))
    assert device.taken == expected
    device.taken.clear()


def test_each_key_sets_its_control(display: str) -> None:
    keys = {
        "<Right>": [(Control.YAW, ORBIT_STEP)],
        "<Left>": [(Control.YAW, 0)],
        "<Up>": [(Control.PITCH, ORBIT_STEP)],
        "<Down>": [(Control.PITCH, 0)],
        "<Prior>": [(Control.ZOOM, 32)],
        "<Next>": [(Control.ZOOM, 0)],
        "<Shift-Right>": [(Control.PAN_X, 16)],
        "<Shift-Left>": [(Control.PAN_X, 0)],
        "<Shift-Up>": [(Control.PAN_Y, 16)],
        "<Key-0>": [(Control.PAN_Y, 0)],
        "<Key-3>": [(Control.SCENE, 2)],
        "n": [(Control.SCENE, 3)],
        "p": [(Control.SCENE, 2)],
        "h": [(Control.SHADING, 1)],
        "t": [(Control.TEXTURE_ERROR, 1)],
        "a": [(Control.ANTIALIASING, 4)],
        "v": [(Control.VIEW, 1)],
        "<Key-V>": [(Control.VIEW, 0)],
        "d": [(Control.PAUSE, 1)],
        "<period>": [(Control.STEP, 1)],
    }
    device = FakeDevice()
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        for key, expected in keys.items():
            viewer.press(key)
            wait_for_input(viewer, device, expected)
        viewer.press("d")
        wait_for_input(viewer, device, [(Control.PAUSE, 0)])
        viewer.press("<period>")  # stands still first, then goes one frame further
        wait_for_input(viewer, device, [(Control.PAUSE, 1), (Control.STEP, 1)])
        viewer.canvas.event_generate("<ButtonPress-3>", x=100, y=100)
        viewer.canvas.event_generate("<B3-Motion>", x=90, y=104)
        viewer.root.update()
        wait_for_input(viewer, device, [(Control.YAW, 10 * ORBIT_PER_PIXEL), (Control.PITCH, 4 * ORBIT_PER_PIXEL)])
        viewer.canvas.event_generate("<Button-4>", x=100, y=100, state=0x4)
        wait_for_input(viewer, device, [(Control.ZOOM, 32)])


@pytest.mark.parametrize(
    ("key", "last"), [("<Right>", (Control.YAW, 60 * ORBIT_STEP & 0xFFFF)), ("n", (Control.SCENE, 59 % 4))]
)
def test_a_key_that_is_held_down_does_not_flood_the_link(display: str, key: str, last: tuple[Control, int]) -> None:
    """The device shows two frames a second, and confirms no INPUT in between; sixty are asked for in a second, or in
    however long that takes here: with each frame it may get no more than the session may have under way."""
    device, sessions = FakeDevice(), [Session()]
    with (
        PtyDevice(device, frame_s=0.5) as served,
        at_work(display, served.port, new_session=lambda: sessions[-1]) as viewer,
    ):
        viewer.until(lambda: viewer.model.frames > 0)
        before = len(device.sent)
        for _ in range(60):
            viewer.press(key)
            viewer.live(0.015)
            assert sessions[-1].inputs_waiting <= 4
        viewer.until(lambda: device.taken and device.taken[-1] == last)
        assert len(device.taken) <= 4 * (len(device.sent) - before + 1)


def test_help_greys_what_the_device_does_not_know(display: str) -> None:
    device = FakeDevice(controls=1 << Control.SCENE)
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        for key in ("<question>", "<F1>"):
            viewer.press(key)
            viewer.settle()
            assert viewer.window.help.visible
            assert viewer.window.help.greyed() >= {"orbit", "shading", "next, previous debug view"}
            assert not viewer.window.help.greyed() & {"next, previous scene", "screenshot", "full screen"}
            viewer.press("<Escape>")
            assert not viewer.window.help.visible
        viewer.press("<Right>", "v", "2")
        wait_for_input(viewer, device, [(Control.SCENE, 1)])


def test_the_device_s_choices_are_told_again_after_its_restart(display: str) -> None:
    device = FakeDevice()
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        viewer.press("v", "<Right>")
        wait_for_input(viewer, device, [(Control.VIEW, 1), (Control.YAW, ORBIT_STEP)])
        viewer.until(lambda: viewer.canvas.find_withtag("legend") != ())
        with served.lock:
            device.reboot(99, time.monotonic())
        viewer.until(lambda: (Control.VIEW, 1) in device.taken and (Control.YAW, ORBIT_STEP) in device.taken)


@pytest.mark.parametrize("key", ["<Key-f>", "<F11>"])
def test_full_screen_is_the_picture_alone(display: str, key: str) -> None:
    with PtyDevice(FakeDevice()) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        viewer.settle()
        before = viewer.root.winfo_width(), viewer.root.winfo_height()
        screen = viewer.root.winfo_screenwidth(), viewer.root.winfo_screenheight()
        viewer.press(key)
        viewer.until(lambda: (viewer.canvas.winfo_width(), viewer.canvas.winfo_height()) == screen)
        viewer.press("<Tab>")
        viewer.until(lambda: viewer.canvas.winfo_width() == screen[0] - 300)
        viewer.press("<Escape>")
        viewer.until(lambda: (viewer.root.winfo_width(), viewer.root.winfo_height()) == before)


def test_plus_and_minus_change_the_window_by_whole_scales(display: str) -> None:
    with PtyDevice(FakeDevice(160, 120)) as served, at_work(display, served.port, scale=3) as viewer:
        viewer.until(lambda: viewer.model.frames > 2)
        viewer.until(lambda: viewer.canvas.winfo_width() == 480)
        viewer.press("<plus>")
        viewer.until(lambda: (viewer.canvas.winfo_width(), viewer.canvas.winfo_height()) == (640, 480))
        viewer.press("<minus>")
        viewer.until(lambda: (viewer.canvas.winfo_width(), viewer.canvas.winfo_height()) == (480, 360))
        viewer.press("l")
        viewer.until(lambda: viewer.canvas.winfo_height() > 360)
