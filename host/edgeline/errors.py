"""The root of everything that Edgeline raises on purpose: one line that says what, where and what to do."""

from __future__ import annotations

import shlex
import sys


class EdgelineError(Exception):
    """A problem that the user can act on.

    `exit_code` is the status with which the command line ends: 2 for a bad command line or file.
    """

    exit_code = 2


class PackageError(EdgelineError):
    """A library that only some commands need is not installed. Says how the Python that runs gets it, as the pip of
    another one would put it elsewhere.
    """

    def __init__(self, what: str, package: str) -> None:
        """`what` is what is not done, with its verb: `charts need`."""
        command = shlex.join([sys.executable, "-m", "pip", "install", package])
        super().__init__(f"{what} the package {package}; install it with: {command}")


class WireError(EdgelineError):
    """Bytes that break a rule of WIRE.md. A session counts them as damage; it never lets this out."""

    exit_code = 4


class OutputError(EdgelineError):
    """A file that cannot be written. Whatever stood there before is still there."""


class DeviceError(EdgelineError):
    """No device to talk to: the port is absent, busy or forbidden, or nothing on it speaks this version of Edgeline."""

    exit_code = 3


class StreamError(EdgelineError):
    """The link ended, or brought no verified frame in time."""

    exit_code = 4


class StreamEndError(StreamError):
    """A finite stream (a capture, a pipe) has been read to its end."""
