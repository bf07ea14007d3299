"""QEMU as a board: starts a machine with a program, talks to its UART, stops and looks at it through QMP.

The machine is held (`-S`) until the UART's socket is connected, so that no byte is lost. `screendump` is QEMU's own
picture of the machine's display, which owes nothing to this project.
"""

from __future__ import annotations

import contextlib
import json
import queue
import re
import socket
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from needs import need_tool

CONNECT_S = 10.0
READ_S = 0.05
NO_CYCLE_COUNTER = {f"NVIC: Bad {access} offset 0xdfc" for access in ("read", "write")}
"""What QEMU says when a program starts the cycle counter by DEMCR, which Cortex-M3 and M4 have and QEMU has not."""


def _connect(path: Path) -> socket.socket:
    """Connects to QEMU's socket, which appears a moment after QEMU has started."""
    deadline = time.monotonic() + CONNECT_S
    while True:
        link = socket.socket(socket.AF_UNIX)
        try:
            link.connect(str(path))
            return link
        except OSError:
            link.close()
            if time.monotonic() > deadline:
                raise
            time.sleep(0.01)


class UartTransport:
    """The machine's UART as the host's package wants it (edgeline.transport.Transport).

    A thread takes what the machine says, whether anybody reads it or not: QEMU waits until a byte of the UART is taken,
    and with it the whole machine, its display and QMP."""

    name = "QEMU's UART"
    one_way = False
    baud = 0
    """QEMU's sockets have no rate, whatever the registers say."""

    def __init__(self, path: Path) -> None:
        self._socket = _connect(path)
        self._socket.settimeout(None)
        self._received: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._taker = threading.Thread(target=self._take, daemon=True)
        self._taker.start()

    def _take(self) -> None:
        with contextlib.suppress(OSError):
            while data := self._socket.recv(1 << 16):
                self._received.put(data)

    def read(self) -> bytes:
        try:
            data = self._received.get(timeout=READ_S)
        except queue.Empty:
            return b""
        while not self._received.empty():
            data += self._received.get()
        return data

    def write(self, data: bytes) -> None:
        self._socket.sendall(data)

    def set_baud(self, rate: int) -> bool:
        return True

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._taker.join()
        self._socket.close()


@dataclass
class Machine:
    """A running QEMU; `folder` has its sockets."""

    process: subprocess.Popen[bytes]
    folder: Path

    def __post_init__(self) -> None:
        self._qmp = _connect(self.folder / "q.sock")
        self._qmp.settimeout(CONNECT_S)
        self._answers = self._qmp.makefile("rb")
        json.loads(self._answers.readline())
        self.command("qmp_capabilities")

    def command(self, name: str, **arguments: Any) -> Any:
        """Executes a QMP command and gives what it returns; events in between are left out."""
        self._qmp.sendall(json.dumps({"execute": name, "arguments": arguments}).encode())
        while True:
            line = self._answers.readline()
            assert line, f"QEMU has ended while it did {name}: {self.said()}"
            answer = json.loads(line)
            assert "error" not in answer, f"{name}: {answer['error']['desc']}"
            if "return" in answer:
                return answer["return"]

    def uart(self) -> UartTransport:
        """Connects to the UART. Closed, it can be connected to again; what the machine says in between is lost."""
        return UartTransport(self.folder / "s.sock")

    def run(self) -> None:
        """Lets the held machine go."""
        self.command("cont")

    def screen(self) -> npt.NDArray[np.uint8]:
        """The display's picture, (height, width, 3)."""
        path = self.folder / "screen.ppm"
        self.command("screendump", filename=str(path))
        magic, size, depth, pixels = path.read_bytes().split(b"\n", 3)
        assert (magic, depth) == (b"P6", b"255")
        width, height = map(int, size.split())
        return np.frombuffer(pixels, np.uint8).reshape(height, width, 3)

    def memory(self, address: int, size: int) -> bytes:
        """What the machine has at `address`, as the processor sees it."""
        path = self.folder / "memory.bin"
        self.command("memsave", val=address, size=size, filename=str(path))
        return path.read_bytes()

    def said(self) -> str:
        """QEMU's own complaints so far: accesses to what is not there, among others."""
        return (self.folder / "stderr.txt").read_text(errors="replace").strip()

    def close(self) -> None:
        self._answers.close()
        self._qmp.close()


@dataclass(frozen=True)
class Symbols:
    """The addresses of a program's variables and of the linker's marks."""

    addresses: dict[str, int]

    def __getitem__(self, name: str) -> int:
        """A variable within a function is called as in the source; GCC's number behind it is left out."""
        found = {at for symbol, at in self.addresses.items() if re.sub(r"\.\d+$", "", symbol) == name}
        assert len(found) == 1, f"{len(found)} symbols are called {name}"
        return found.pop()


def symbols(elf: Path) -> Symbols:
    nm = need_tool("arm-none-eabi-nm", "binutils-arm-none-eabi")
    listed = subprocess.run([nm, str(elf)], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in listed.splitlines()]
    return Symbols({row[2]: int(row[0], 16) for row in rows if len(row) == 3})


PAINT = 0xA5


@dataclass(frozen=True)
class Stack:
    """The program's stack, painted before it starts: QEMU's loader fills it, so that the image stays what it is."""

    begin: int
    end: int

    @classmethod
    def of(cls, elf: Path) -> Stack:
        marks = symbols(elf)
        return cls(marks["el_stack_begin"], marks["el_stack_end"])

    def paint(self, folder: Path) -> tuple[str, str]:
        """The options for `machine` that paint it."""
        path = folder / "paint.bin"
        path.write_bytes(bytes([PAINT]) * (self.end - self.begin))
        return "-device", f"loader,file={path},addr={self.begin:#x},force-raw=on"

    def left(self, board: Machine) -> int:
        """Bytes that the program has never written."""
        kept = board.memory(self.begin, self.end - self.begin)
        return len(kept) - len(kept.lstrip(bytes([PAINT])))


@contextmanager
def machine(name: str, elf: Path, *options: str) -> Iterator[Machine]:
    """QEMU's machine `name` with the program `elf`, held until `run`."""
    emulator = ("qemu-system-riscv32", "qemu-system-misc") if name == "virt" else ("qemu-system-arm",) * 2
    qemu = need_tool(*emulator)
    wanted = [
        *(qemu, "-M", name, "-kernel", str(elf), "-display", "none", "-monitor", "none", "-S"),
        *("-d", "guest_errors", "-qmp", "unix:q.sock,server=on,wait=off"),
        *("-serial", "unix:s.sock,server=on,wait=off", *options),
    ]
    # A folder of its own, because a socket's name has at most 107 bytes, fewer than pytest's folders.
    with tempfile.TemporaryDirectory(prefix="edgeline-") as name_of_folder:
        folder = Path(name_of_folder)
        with (folder / "stderr.txt").open("wb") as complaints:
            process = subprocess.Popen(
                wanted, cwd=folder, stdin=subprocess.DEVNULL, stdout=complaints, stderr=subprocess.STDOUT
            )
        running = None
        try:
            running = Machine(process, folder)
            yield running
        finally:
            # Not by QMP's `quit`: that waits for ever for a UART whose bytes nobody takes.
            process.kill()
            process.wait(10)
            if running is not None:
                running.close()
