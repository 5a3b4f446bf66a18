"""JavaScript of the screens has no type errors, nothing that the linter finds, and its format."""

import shutil
import subprocess
from pathlib import Path

import pytest

WEB = Path(__file__).parents[2] / "web-bundle"


@pytest.mark.skipif(
    not (shutil.which("npm") and (WEB / "node_modules").is_dir()),
    reason="needs Node and its packages: make web-lint installs them",
)
def test_the_modules_of_the_screens_have_no_type_errors_and_no_lint() -> None:
    run = subprocess.run(
        ["npm", "--prefix", str(WEB), "--silent", "run", "lint"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
