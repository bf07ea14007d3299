"""Files that never leave what stood there before half overwritten."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import IO

from edgeline.errors import OutputError


class AtomicFile:
    """A file that appears under its name when it is complete, or not at all."""

    def __init__(self, path: str) -> None:
        self.path = Path(path)
        if self.path.is_dir():
            raise OutputError(f"{path}: is a folder: name a file in it")
        try:
            descriptor, name = tempfile.mkstemp(".part", f".{self.path.name}.", self.path.parent)
        except OSError as error:
            raise cannot_write(path, error) from None
        self._temporary = Path(name)
        self.name = name
        """what it is called until then"""
        self.stream: IO[bytes] = os.fdopen(descriptor, "w+b")

    def commit(self) -> None:
        """Gives the file its name. Raises OSError."""
        self.stream.flush()
        os.fsync(self.stream.fileno())
        self.stream.close()
        umask = os.umask(0)
        os.umask(umask)
        self._temporary.chmod(0o666 & ~umask)  # mkstemp makes files for the user alone
        self._temporary.replace(self.path)

    def discard(self) -> None:
        """Removes what was not committed. Never raises."""
        with contextlib.suppress(OSError):
            self.stream.close()
        with contextlib.suppress(OSError):
            self._temporary.unlink()


class GrowingFile:
    """A file that is of use while it grows: at once under its name where nothing stands there, so that a killed program
    leaves it; as an AtomicFile where something does."""

    def __init__(self, path: str) -> None:
        self.path = Path(path)
        self._replacing: AtomicFile | None = None
        try:
            self.stream: IO[bytes] = self.path.open("xb")
        except FileExistsError:
            self._replacing = AtomicFile(path)
            self.stream = self._replacing.stream
        except OSError as error:
            raise cannot_write(path, error) from None
        self._open = True

    def commit(self) -> None:
        """Keeps the file. Raises OSError."""
        self._open = False
        if self._replacing is not None:
            self._replacing.commit()
        else:
            self.stream.close()

    def discard(self) -> None:
        """Removes the file if it has not been committed. Never raises."""
        if self._replacing is not None:
            self._replacing.discard()
        elif self._open:
            with contextlib.suppress(OSError):
                self.stream.close()
            with contextlib.suppress(OSError):
                self.path.unlink()
        self._open = False


def check_writable(path: str) -> None:
    """Raises OutputError if a file of this name could not be written, before anyone waits for its content."""
    AtomicFile(path).discard()


def cannot_write(path: str, error: OSError) -> OutputError:
    return OutputError(f"{path}: cannot be written: {error.strerror or error}")
