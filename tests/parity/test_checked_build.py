"""A core built with bounds checks lives through the same nonsense: no index is out of range."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TESTS = (
    "tests/kernel/test_robustness.py",
    "tests/kernel/jog/test_jog.py",
    "tests/parity/test_parity.py",
    "tests/fuzz/test_extremes.py",  # every command with numbers nothing can have
    "tests/fuzz/test_lines.py",  # 20 000 lines, typed and stored
)
PYTEST = ["-m", "pytest", "-n0", "-m", "not soak", *TESTS]


@pytest.mark.soak
@pytest.mark.timeout(900)
def test_no_index_is_out_of_range(tmp_path: Path) -> None:
    for name in ("setup.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tmp_path)
    unwanted = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    for name in ("src", "tests"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=unwanted)
    environment = os.environ | {
        "OPENACR_CHECKED": "1",
        "OPENACR_REQUIRE_EXT": "1",
        "PYTHONPATH": os.pathsep.join((str(tmp_path / "src"), str(tmp_path))),
    }
    for command in (["setup.py", "build_ext", "--inplace", "-q"], PYTEST):
        done = subprocess.run(
            [sys.executable, *command],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
