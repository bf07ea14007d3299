"""The emulated Pico (rp2040/run.mjs) and a host that talks to it in emulated time.

Both advance in lock-step: the board runs for a while, the host reads what the UART sent and answers, and so on. A test
takes the same course each time, however slow the machine is.
"""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from edgeline.events import Event, Frame, Log, SetRate
from edgeline.session import Session
from needs import missing, need_tool
from target_tools import BUILD, Image, only_one

HARNESS = Path(__file__).parent / "rp2040"

MS = 1_000_000
"""Emulated time is counted in nanoseconds."""

STEP_NS = 2 * MS
"""How long the host may sleep; much less than its own time limits."""

UART_SPEED = 64
"""How much faster than its baud rate the UART's line is towards the host, unless a test says otherwise."""

STEP_TIMEOUT_S = 120


def emulator() -> Path:
    """The folder of node_modules with rp2040js, installed where it is not; skips where that cannot be."""
    node = need_tool("node", "nodejs 18 or newer")
    npm = need_tool("npm", "npm")
    version = subprocess.run([node, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    if int(version.removeprefix("v").split(".")[0]) < 18:
        missing(f"node is {version}: install 18 or newer")
    wanted = json.loads((HARNESS / "package.json").read_text())["dependencies"]["rp2040js"]
    folder = BUILD / "node"
    with only_one("node"):
        installed = folder / "node_modules" / "rp2040js" / "package.json"
        if installed.is_file() and json.loads(installed.read_text())["version"] == wanted:
            return folder
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(HARNESS / "package.json", folder)
        command = [npm, "install", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts"]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, check=False)
        if done.returncode != 0:
            missing(f"rp2040js {wanted} cannot be installed: {done.stderr.strip().splitlines()[-1]}")
    return folder


class BoardStopped(AssertionError):
    """The board did something after which a run means nothing any more, or started anew; the text says what."""


@dataclass(frozen=True)
class Report:
    """What the harness knows at the end of a step; see rp2040/board.mjs."""

    values: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        try:
            return self.values[name]
        except KeyError:
            raise AttributeError(name) from None

    def assert_clean(self) -> None:
        """Fails where the board did anything that a chip or a display would not have taken."""
        assert not self.values["problems"], "\n".join(self.values["texts"])


class Pico:
    """One emulated board from its power-on. A context manager; `folder` takes the wire trace."""

    def __init__(self, image: Image, folder: Path, uart_speed: int = UART_SPEED, frame_at: str = "") -> None:
        """`frame_at`: the function that begins a frame, by which frames are told apart where they have no end on the
        wire."""
        self.trace = folder / "wire.trace"
        self.now_ns = 0
        self.frame_ends = 0
        self.baud = 115200
        """The rate of the host's port."""
        command = ["node", str(HARNESS / "run.mjs"), str(image.uf2), "--modules", str(emulator())]
        command += ["--trace", str(self.trace), "--uart-speed", str(uart_speed), "--stdio"]
        begin, end = stack_of(image)
        if frame_at:
            command += ["--frame-at", str(symbols_of(image)[frame_at] & ~1)]
        command += ["--stack", f"{begin}-{end}"]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self) -> Pico:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process.stdin is not None:
            self._process.stdin.close()
        self._process.wait(STEP_TIMEOUT_S)
        if self._process.stdout is not None:
            self._process.stdout.close()

    def step(self, ns: int, rx: bytes = b"", *, hold_tx: bool = False, until_frame: bool = False) -> bytes:
        """Lets `ns` pass while the bytes `rx` arrive one after another, and gives what the UART sent.

        With `until_frame` it ends with a picture, if one is complete before. While `hold_tx` the UART's line takes
        nothing. Raises BoardStopped."""
        host = {"rx": base64.b64encode(rx).decode(), "baud": self.baud}
        answer = self._ask({"ns": ns, **host, "hold_tx": hold_tx, "until_frame": until_frame})
        if answer["fatal"]:
            raise BoardStopped("\n".join(self.report().texts))
        return base64.b64decode(answer["tx"])

    def last_words(self, ns: int) -> bytes:
        """What the UART sends within `ns`, in which the board must stop or start anew."""
        answer = self._ask({"ns": ns})
        assert answer["fatal"], "the board goes on"
        return base64.b64decode(answer["tx"])

    def step_and_report(self, ns: int) -> Report:
        """Lets `ns` pass, in spite of what may stop the board, and tells all that is known."""
        return Report(self._ask({"ns": ns, "report": True})["report"])

    def report(self) -> Report:
        """All that is known until now."""
        return Report(self._ask({"report": True})["report"])

    def wire_until_picture(self, number: int) -> Path:
        """The wire trace up to where the display had its picture `number`, counted from 0."""
        cut = self.trace.with_name(f"picture-{number}.trace")
        with self.trace.open("rb") as trace:
            cut.write_bytes(trace.read(self.report().frame_ends[number]))
        return cut

    def _ask(self, question: dict[str, Any]) -> dict[str, Any]:
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write(json.dumps(question) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        assert line, f"the harness has ended with status {self._process.wait(STEP_TIMEOUT_S)}"
        answer: dict[str, Any] = json.loads(line)
        self.now_ns = answer["now_ns"]
        self.frame_ends = answer["frame_ends"]
        return answer


class Host:
    """The edgeline package's session on an emulated board."""

    def __init__(self, pico: Pico, session: Session | None = None) -> None:
        self.pico = pico
        self.session = session or Session()
        self.logs: list[str] = []

    def step(self, ns: int = STEP_NS) -> list[Event]:
        """Lets the board run for `ns` and gives what its bytes meant. The host speaks first when it has been greeted:
        before that the board's UART may not be there, and a PING would be lost for half a second."""
        if self.session.hello is not None:
            self.session.tick(self.pico.now_ns / 1e9)
        data = self.pico.step(ns, self.session.bytes_to_send())
        events = self.session.receive(data, self.pico.now_ns / 1e9)
        for event in events:
            if isinstance(event, Log):
                self.logs.append(event.text)
            elif isinstance(event, SetRate):
                self.pico.baud = event.rate
        return events

    def next_frame(self, within_ms: int = 5000) -> Frame:
        """The next verified frame, within emulated milliseconds."""
        end = self.pico.now_ns + within_ms * MS
        while self.pico.now_ns < end:
            for event in self.step():
                if isinstance(event, Frame):
                    return event
        raise AssertionError(f"no verified frame within {within_ms} ms; the board said {self.logs}")

    def run_until_picture(self, number: int, within_ms: int = 5000) -> None:
        """Goes on until the display has its picture `number`, counted from 0 as frames are."""
        end = self.pico.now_ns + within_ms * MS
        while self.pico.frame_ends <= number:
            assert self.pico.now_ns < end, f"the display has no picture {number} within {within_ms} ms"
            self.step()


def symbols_of(image: Image) -> dict[str, int]:
    """The program's symbols and their addresses."""
    nm = need_tool("arm-none-eabi-nm", "gcc-arm-none-eabi")
    lines = subprocess.run([nm, str(image.elf)], capture_output=True, text=True, check=True).stdout.splitlines()
    return {words[2]: int(words[0], 16) for words in map(str.split, lines) if len(words) == 3}


def stack_of(image: Image) -> tuple[int, int]:
    """First address of the stack and the one after its last, by the linker's symbols."""
    symbols = symbols_of(image)
    return symbols["el_stack_begin" if "el_stack_begin" in symbols else "el_bss_end"], symbols["el_stack_end"]
