"""The tests of the core pass with the core as plain Python, too."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from openacr import compiled

ROOT = Path(__file__).parents[2]
TESTS = (
    "tests/engine", "tests/kernel", "tests/plant", "tests/plc",
    "tests/test_build.py::test_plain_python_is_used_when_asked_for",
)  # fmt: skip
# What takes most of the time, most of it searches; test_corners.py compares both builds to the bit.
SLOW = (
    "tests/kernel/jog/test_homing.py",
    "tests/kernel/path/test_barred_corners.py",
    "tests/kernel/path/test_corners.py",
    "tests/kernel/path/test_late_corners.py",
    "tests/kernel/path/test_relaid_moves.py",
    "tests/kernel/path/test_replaced_corners.py",
    "tests/kernel/path/test_shown_motion.py",
    "tests/kernel/path/test_switched_corners.py",
    "tests/kernel/status/test_limits_by_state.py",
    "tests/kernel/status/test_limits_of_locked_axes.py",
)


@pytest.mark.skipif(not compiled.is_compiled, reason="all tests run as plain Python")
@pytest.mark.timeout(900)
@pytest.mark.parametrize("slow", [SLOW, pytest.param((), marks=pytest.mark.soak)])
def test_the_core_passes_its_tests_as_plain_python(slow: tuple[str, ...]) -> None:
    # a cache of its own: the other one belongs to the run that this test is part of
    options = ("-n", "0", "-m", "not soak", "-o", "cache_dir=build/pytest-plain")
    left_out = [f"--ignore={name}" for name in slow]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *left_out, *TESTS],
        env=os.environ | {"OPENACR_PURE": "1"},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
