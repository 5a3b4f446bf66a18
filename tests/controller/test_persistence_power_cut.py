"""The power goes at a random moment of a save or download: the old image or the new one."""

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

PROGRAM = Path(__file__).with_name("power_cut.py")
pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a system that can fork")


def cut_power(folder: Path, kind: str, cuts: int, seed: int) -> Counter[str]:
    """How often the old image, the new one, or a download half done was found."""
    found = subprocess.run(
        [sys.executable, str(PROGRAM), str(folder / kind), kind, str(cuts), str(seed)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert found.returncode == 0, found.stderr
    *counts, _ = found.stdout.split()
    return Counter({name: int(count) for name, count in (each.split("=") for each in counts)})


@pytest.mark.parametrize("kind", ["flash", "battery"])
def test_a_few_power_cuts(tmp_path: Path, kind: str) -> None:
    assert cut_power(tmp_path, kind, 5, seed=7).total() == 5


@pytest.mark.soak
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("kind", ["flash", "battery"])
def test_500_power_cuts(tmp_path: Path, kind: str) -> None:
    seen = cut_power(tmp_path, kind, 250, seed=11)
    assert seen.total() == 250
    assert min(seen["old"] + seen["download"], seen["new"]) > 10
