"""What commands say: progress, the device's words, JSON."""

from __future__ import annotations

import json
import sys


def progress(text: str) -> None:
    """Replaces the line of progress; nothing where nobody watches."""
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def complain(text: str) -> None:
    """One line of error, after which the command goes on or ends. A device's words may be in it."""
    progress("")
    print(f"edgeline: {printable(text)}", file=sys.stderr)


def device_says(text: str) -> None:
    progress("")
    for line in text.splitlines():
        print(f"device: {printable(line)}", file=sys.stderr)


def printable(text: str) -> str:
    """What a device or a file says, without what would steer the terminal."""
    return "".join(c if c.isprintable() else " " for c in text)


def print_json(result: object) -> None:
    print(json.dumps(result, indent=2))
