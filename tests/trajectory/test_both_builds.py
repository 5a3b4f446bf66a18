"""Compiled and plain Python plan the same bits."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.trajectory.measures import limits, planned, points

from openacr.compiled import is_compiled
from openacr.trajectory import Arc, Segment

ROOT = Path(__file__).parents[2]
PROGRAM = [
    Segment(1, (2.0, 0.0), 50.0, 0.01),
    Segment(2, (2.6, 0.1), 50.0, 0.01),
    Segment(3, (3.2, 0.1), 40.0, 0.01, arc=Arc(0, 1, (2.9, 0.1), -3.0)),
    Segment(4, (3.2, 2.0), 50.0, 0.01),
    Segment(5, (0.0, 2.0), 50.0, 0.01, is_rapid=True),
]


def digest() -> str:
    """Of the control points of a program with every kind of chain."""
    return hashlib.sha256(
        points(planned(PROGRAM, (0.0, 0.0), limits(axes=2))).tobytes()
    ).hexdigest()


@pytest.mark.skipif(not is_compiled, reason="there is one build only")
def test_both_builds_give_the_same_bits() -> None:
    run = subprocess.run(
        [sys.executable, "-c", f"from {__name__} import digest; print(digest())"],
        env={**os.environ, "OPENACR_PURE": "1"}, cwd=ROOT, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert run.stdout.strip() == digest()
