"""`edgeline ... | head` ends quietly: no traceback when who reads the output has seen enough."""

from __future__ import annotations

import subprocess
import sys

from edgeline.cli import PIPE_CLOSED


def test_a_reader_that_leaves_ends_the_command_without_a_word() -> None:
    command = [sys.executable, "-u", "-m", "edgeline", "budget", "--panel", "ili9341"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == PIPE_CLOSED
