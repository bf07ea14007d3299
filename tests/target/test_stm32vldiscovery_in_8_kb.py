"""The image of the STM32 VL Discovery: its scenes in 8 KB of RAM, streamed, in QEMU; and in Unicorn, with a
strict model of SPI1 that shows what the SSD1306 gets. Every picture is the simulator's, pixel for pixel."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import qemu
from qemu_demo import FRAMES, SIZE, START, Demo, Progress, leave_in_mid_frame, pictures, streaming
from target_tools import Image, Simulator, assert_same_picture, build_faulty
from unicorn_display import Display, Host, Wiring
from unicorn_stm32 import f100

MACHINE = "stm32vldiscovery"

SCENES = ("solid", "teapot", "room")
"""In the order of firmware/apps/tiny/scene_list.c: a scene's place is its number in INPUT."""

RAM_BEGIN, RAM_END = 0x20000000, 0x20002000

STACK_MARGIN = 256
"""Bytes of the stack that were never used: for an interrupt at the deepest point, and for the next compiler."""

PATIENCE_S = 15.0
PATIENCE_MS = 60_000


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    return board_image("stm32vldiscovery")


@pytest.fixture(scope="module")
def demo(image: Image, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Demo]:
    """The board in QEMU after its start, for all tests of this file: each goes on where the last one stopped."""
    paint = qemu.Stack.of(image.elf).paint(tmp_path_factory.mktemp("stack"))
    with streaming(MACHINE, image.elf, *paint) as running:
        yield running


@pytest.mark.parametrize("scene", SCENES)
def test_every_scene_on_the_stream(scene: str, demo: Demo, simulator: Simulator, tmp_path: Path) -> None:
    expected = pictures(simulator, scene, tmp_path)
    for i, frame in enumerate(FRAMES):
        assert_same_picture(demo.show(SCENES.index(scene), frame), expected[i], f"{scene}, frame {frame}")
    assert demo.link.session.counts.damaged == 0


def test_the_stack_has_room_left(image: Image, demo: Demo) -> None:
    left = qemu.Stack.of(image.elf).left(demo.board)
    print(f"{left} bytes of the stack were never used")
    assert left >= STACK_MARGIN


def test_everything_is_in_8_kb_and_the_linker_sees_to_it(image: Image, tmp_path: Path) -> None:
    end = qemu.symbols(image.elf)["el_stack_end"]
    print(f"{end - RAM_BEGIN} bytes of RAM, stack included")
    assert end <= RAM_END
    fault = ("ram_limit = 8K;", f"ram_limit = {end - RAM_BEGIN - 8};")
    with pytest.raises(AssertionError, match="the program takes more RAM than ram_limit"):
        build_faulty("stm32vldiscovery", {"firmware/boards/stm32vldiscovery/stm32vldiscovery.ld": [fault]}, tmp_path)


def test_it_goes_on_without_a_host(image: Image) -> None:
    with qemu.machine(MACHINE, image.elf) as board:
        board.run()
        assert Progress.of(board, image.elf).goes_on(10, PATIENCE_S)


def test_it_goes_on_when_a_host_goes_away_in_the_middle_of_a_frame(image: Image) -> None:
    with qemu.machine(MACHINE, image.elf) as board:
        uart = board.uart()
        board.run()
        leave_in_mid_frame(uart)
        assert Progress.of(board, image.elf).goes_on(10, PATIENCE_S)


def test_it_goes_on_when_the_uart_takes_nothing(tmp_path: Path) -> None:
    """Its transmitter is full for ever. A START comes, so the board tries to send: frames wait a little, and go on."""
    full = ("(registers->sr & SR_TX_EMPTY) != 0 &&", "(registers->sr & 0U) != 0 &&")
    image = build_faulty("stm32vldiscovery", {"firmware/boards/stm32/usart.c": [full]}, tmp_path)
    with streaming(MACHINE, image.elf) as demo:
        demo.link.transport.write(START)
        assert Progress.of(demo.board, image.elf).goes_on(10, PATIENCE_S)


def on_the_glass(image: Image, scene: str, simulator: Simulator, folder: Path) -> None:
    """Frame 0 of `scene` on the strict model: the stream and the glass against the simulator's."""
    chip = f100(image.elf)
    display = Display(chip, Wiring())
    host = Host(chip)
    host.begin(SCENES.index(scene), 0)
    host.run(lambda: len(host.frames) == 2, PATIENCE_MS)
    shown = simulator.look(display.write_trace(folder / "wire"), "ssd1306", SIZE)
    assert_same_picture(host.frames[1].picture, simulator.render(scene, SIZE, folder)[0], f"{scene}, on the stream")
    assert_same_picture(shown, simulator.render(scene, SIZE, folder, "ssd1306")[0], f"{scene}, on the glass")


@pytest.mark.parametrize("scene", SCENES[:2])
def test_the_glass_shows_the_same(scene: str, image: Image, simulator: Simulator, tmp_path: Path) -> None:
    on_the_glass(image, scene, simulator, tmp_path)


DISPLAY = "firmware/boards/stm32vldiscovery/display.c"
BOARD = "firmware/boards/stm32vldiscovery/board.c"
DRIVER = "firmware/src/panel/oled.c"

SEND = "        SPI_DR = bytes[i];\n    }\n"
SET_DATA_COMMAND = "    GPIO_SET_RESET(GPIO_A) = data_command;\n"

FAULTS = {
    "D/C changes to 1 while SPI1 is busy": {
        DISPLAY: [("    wait_until_idle();\n" + SET_DATA_COMMAND, ""), (SEND, SEND + SET_DATA_COMMAND)],
    },
    "SPI1 is given a word while one waits": {
        DISPLAY: [("        while ((SPI_SR & SPI_SR_TX_EMPTY) == 0) {\n        }\n        SPI_DR", "        SPI_DR")],
    },
    "the display is not selected": {
        DISPLAY: [("GPIO_CLEAR(SELECT_PIN) | GPIO_CLEAR(RESET_PIN)", "GPIO_SET(SELECT_PIN) | GPIO_CLEAR(RESET_PIN)")],
    },
    "SPI1.*clock": {BOARD: [("RCC_APB2ENR_PORT_A | RCC_APB2ENR_SPI1 |", "RCC_APB2ENR_PORT_A |")]},
    "pixels differ": {DRIVER: [("        set_units(panel, 0, ", "        set_units(panel, 1, ")]},
}
"""What must be said -> the fault: D/C changes when the bytes are out already; no wait for room; a chip select that is
never low; a part without its clock; a window that begins one page too low."""


@pytest.mark.parametrize("complaint", FAULTS)
def test_a_fault_is_seen(complaint: str, simulator: Simulator, tmp_path: Path) -> None:
    image = build_faulty("stm32vldiscovery", FAULTS[complaint], tmp_path)
    with pytest.raises((AssertionError, pytest.fail.Exception), match=complaint):
        on_the_glass(image, "solid", simulator, tmp_path)
