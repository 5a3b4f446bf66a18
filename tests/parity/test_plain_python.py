"""The tests of the core pass with the core as plain Python, too."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from openacr import compiled

ROOT = Path(__file__).parents[2]
TESTS = ("tests/engine", "tests/kernel", "tests/plant", "tests/plc", "tests/test_build.py")


@pytest.mark.skipif(not compiled.is_compiled, reason="all tests run as plain Python")
@pytest.mark.timeout(900)
def test_the_core_passes_its_tests_as_plain_python() -> None:
    # a cache of its own: the other one belongs to the run that this test is part of
    options = ("-n", "0", "-m", "not soak", "-o", "cache_dir=build/pytest-plain")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *TESTS],
        env=os.environ | {"OPENACR_PURE": "1"},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
