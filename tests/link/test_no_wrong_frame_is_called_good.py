"""Every case of cases.py, shortened: no wrong frame is called good, no INPUT is lost, doubled or out of order, the
picture is whole again as soon as is promised, and the session says how bad the link is. At length: tests/link/run."""

from __future__ import annotations

from pathlib import Path

import pytest

from cases import CASES
from conversation import Case, Conversation

FRAMES = 90
BAD = [case for case in CASES if "1e-4" in case.name]


@pytest.mark.parametrize("case", CASES, ids=[case.name for case in CASES])
def test_case(program: Path, case: Case) -> None:
    """What does not hold raises WrongError, which says what it was."""
    frames = max(1, round(FRAMES * case.share))
    outcome = Conversation(program, case, 1).run(frames)
    assert outcome.frames >= frames
    if case.fast is not None:
        assert outcome.rates == {case.boot.rate, case.fast}


@pytest.mark.parametrize("case", BAD, ids=[case.name for case in BAD])
def test_a_bad_link_is_called_bad(program: Path, case: Case) -> None:
    outcome = Conversation(program, case, 2).run(max(4, round(40 * case.share)))
    assert "frames failed" in outcome.quality and "bit errors about" in outcome.quality
    whole_in_one_packet = (case.boot.width, case.boot.height) == (64, 48)
    assert whole_in_one_packet or outcome.partial > 0, "what is proven of a frame that failed is shown"


def test_the_same_seed_has_the_same_faults(program: Path) -> None:
    case = next(case for case in CASES if case.name == "everything")
    first, second = (Conversation(program, case, 3).run(40) for _ in range(2))
    assert first == second and first.faults > 0
