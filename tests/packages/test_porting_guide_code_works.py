"""The code of firmware/PORTING.md: it compiles without a warning, and on a chip that is as strict as a real one the
display shows its picture, the link carries its bytes, and the fault report arrives.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from edgeline import framing, protocol
from needs import need_tool
from packages_tools import ARM, FIRMWARE, HERE, NATIVE, RISCV, STRICT, Picture, Target, compile_units, look, run, tried

GUIDE = FIRMWARE / "PORTING.md"
SOURCES = ["bus.c", "bus_dma.c", "port.c", "board.c", "trap.c", "first_picture.c"]
INCLUDES = (f"-I{FIRMWARE / 'src'}", f"-I{FIRMWARE / 'boards'}")


@pytest.fixture(scope="session")
def guide(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the guide's files, each named by the comment that it begins with."""
    folder = tmp_path_factory.mktemp("guide")
    for block in re.findall(r"^```c\n(.*?)^```$", GUIDE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
        name = re.match(r"/\* (\w+\.[ch])[:,]", block)
        assert name is not None, f"PORTING.md: a block of C does not begin with its file's name: {block[:60]!r}"
        (folder / name[1]).write_text(block, encoding="utf-8")
    assert sorted(path.name for path in folder.iterdir()) == sorted([*SOURCES, "chip.h"])
    return folder


def build(folder: Path, units: Sequence[Path], library: Sequence[Path], out: Path) -> Path:
    """Links guide and test files with the library into a program of this machine."""
    flags = ["-std=c11", "-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", *STRICT]
    objects = compile_units(NATIVE.c, units, [*flags, *INCLUDES, f"-I{folder}"], out)
    program = out / "program"
    run(*NATIVE.c, "-fsanitize=address,undefined", *objects, *library, "-o", program)
    return program


def first_picture() -> Picture:
    """What first_picture.c says that it draws, at 320 x 240."""
    y, x = np.mgrid[0:240, 0:320]
    picture: Picture = ((y & 0x78) >> 3).astype(np.uint16)
    picture[200:, :40] = 0x001F
    picture[:40, 280:] = 0x07E0
    picture[:40, :40] = 0xF800
    picture[(x == 0) | (y == 0) | (x == 319) | (y == 239)] = 0xFFFF
    return picture


@pytest.mark.parametrize("target", [ARM, RISCV], ids=["Cortex-M0+", "RISC-V"])
def test_it_compiles_for_boards(guide: Path, target: Target, tmp_path: Path) -> None:
    need_tool(target.c[0], target.package)
    flags = ["-std=c11", "-O2", *STRICT, *INCLUDES]
    compile_units(target.c, [guide / name for name in SOURCES], flags, tmp_path)


@pytest.mark.parametrize("bus", ["bus.c", "bus_dma.c"])
def test_the_first_picture_is_on_the_glass(bus: str, guide: Path, native_library: list[Path], tmp_path: Path) -> None:
    units = [guide / "first_picture.c", guide / bus, guide / "port.c", HERE / "fake_chip.c"]
    if bus == "bus.c":
        units.append(HERE / "no_dma.c")
    program = build(guide, units, native_library, tmp_path)
    trace = tmp_path / "trace"
    run(program, env={"FAKE_CHIP_TRACE": str(trace)})
    assert np.array_equal(look(trace, "ili9341", 90, (320, 240)), first_picture())


FAULTS = {
    "D/C changes while the wire is busy": (
        "bus.c",
        "    wait_until_idle();\n    chip_pin_dc(dc);",
        "    chip_pin_dc(dc);",
    ),
    "the end of the DMA is taken for an idle wire": (
        "bus_dma.c",
        "    while (chip_spi_is_busy()) {\n    }\n}\n\n/* The only",
        "}\n\n/* The only",
    ),
    "done comes before the DMA has read the pixels": (
        "bus_dma.c",
        "    chip_dma_start(memory, words);",
        "    done(argument);\n    chip_dma_start(memory, words);",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_broken_port_is_seen(fault: str, guide: Path, native_library: list[Path], tmp_path: Path) -> None:
    """The proof that the test above can fail."""
    bus, right, wrong = FAULTS[fault]
    text = (guide / bus).read_text(encoding="utf-8")
    assert text.count(right) == 1, f"{bus}: not once: {right!r}"
    broken = tmp_path / "broken.c"
    broken.write_text(text.replace(right, wrong), encoding="utf-8")
    units = [guide / "first_picture.c", broken, guide / "port.c", HERE / "fake_chip.c"]
    if bus == "bus.c":
        units.append(HERE / "no_dma.c")
    program = build(guide, units, native_library, tmp_path)
    trace = tmp_path / "trace"
    done = tried(program, env={"FAKE_CHIP_TRACE": str(trace)})
    if done.returncode == 0:
        with pytest.raises(AssertionError):
            assert np.array_equal(look(trace, "ili9341", 90, (320, 240)), first_picture())


def echo(guide: Path, native_library: list[Path], tmp_path: Path) -> Path:
    units = [HERE / "echo_main.c", guide / "port.c", guide / "bus_dma.c", HERE / "fake_chip.c"]
    return build(guide, units, native_library, tmp_path)


def test_the_link_carries_bytes_both_ways(guide: Path, native_library: list[Path], tmp_path: Path) -> None:
    sent = bytes((i * 7 + i // 256) % 256 for i in range(5000))
    assert run(echo(guide, native_library, tmp_path), stdin=sent) == sent


def test_a_dead_link_holds_nobody(guide: Path, native_library: list[Path], tmp_path: Path) -> None:
    done = tried(echo(guide, native_library, tmp_path), env={"FAKE_CHIP_UART_DEAD": "1"}, stdin=bytes(5000))
    assert (done.returncode, done.stderr) == (3, b"the link took 1040 bytes\n")  # the ring's 1024, the queue's 16


def test_the_fault_report_arrives(guide: Path, native_library: list[Path], tmp_path: Path) -> None:
    main = tmp_path / "main.c"
    main.write_text(
        "#include <stdint.h>\n"
        "_Noreturn void board_fault(const char *what, uint32_t at, uint32_t called_from);\n"
        "extern const char el_firmware_name[];\n"
        'const char el_firmware_name[] = "test 1.0";\n'
        'int main(void)\n{\n    board_fault("illegal instruction", 0x80001234, 0x800000fe);\n}\n',
        encoding="utf-8",
    )
    # As the guide says: on another processor the report is told how interrupts are turned off.
    text = (FIRMWARE / "boards" / "report.c").read_text(encoding="utf-8")
    asked = re.findall(r'^#error "report.c: say here .*"$', text, re.MULTILINE)
    assert len(asked) == 1, "report.c no longer asks how interrupts are turned off"
    report = tmp_path / "report.c"
    report.write_text('#include "chip.h"\n' + text.replace(asked[0], "(void)chip_interrupts_off();"), encoding="utf-8")
    units = [main, report, *(guide / name for name in ["trap.c", "board.c", "port.c", "bus_dma.c"])]
    output = run(build(guide, [*units, HERE / "fake_chip.c"], native_library, tmp_path))
    assert output[:1] == b"\0"
    [packet] = framing.Splitter().feed(output)
    reported = "illegal instruction, at 80001234, called from 800000fe; test 1.0"
    assert packet == protocol.pack(protocol.Log(reported), 0)
