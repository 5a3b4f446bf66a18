"""One mutant in a copy of the tree: break the file, run the tests, put the file back."""

import os
import shutil
import subprocess
import sys
from enum import StrEnum
from pathlib import Path

from mutation.operators import Mutant

STARTUP_S = 60.0  # what a loaded machine may need to import everything


class Verdict(StrEnum):
    """What became of a mutant."""

    KILLED = "killed"
    ENDLESS = "killed by time"
    SURVIVED = "survived"
    UNREACHED = "reached by no test"


class Tree:
    """A copy of the work tree in which files may be broken, subprocesses of tests included."""

    def __init__(self, path: Path) -> None:
        self.path = path
        shutil.rmtree(path, ignore_errors=True)
        listed = subprocess.run(
            ["git", "ls-files", "-co", "--exclude-standard"],
            check=True,
            capture_output=True,
            text=True,
        )
        built = [str(file) for file in Path("src/openacr").glob("_compiled.*")]
        for name in [*listed.stdout.splitlines(), *built]:
            if Path(name).is_file():
                target = path / name
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(name, target)

    def environment(self, *, pure: bool) -> dict[str, str]:
        """Variables under which tests import this copy, its core compiled or as plain Python."""
        found = {**os.environ, "PYTHONPATH": f"{self.path / 'src'}{os.pathsep}{self.path}"}
        found["PYTHONDONTWRITEBYTECODE"] = "1"  # a broken file must not leave its code in a cache
        found.pop("OPENACR_PURE", None)
        return {**found, "OPENACR_PURE": "1"} if pure else found

    def run(self, mutant: Mutant, tests: list[str], expected_s: float) -> Verdict:
        """Try one mutant with some tests; the first that fails ends the trial."""
        if not tests:
            return Verdict.UNREACHED
        file = self.path / mutant.path
        text = file.read_text()
        names = self.path / "tests.txt"
        names.write_text("\n".join(tests) + "\n")
        file.write_text(mutant.apply(text))
        try:
            return self._verdict(mutant, names, STARTUP_S + 10.0 * expected_s)
        finally:
            file.write_text(text)

    def _verdict(self, mutant: Mutant, names: Path, limit_s: float) -> Verdict:
        pure = mutant.path.endswith("_cy.py")
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-p",
            "no:openacr",  # it would import the package before the mutant
            "-x",
            "-n",
            "0",
            "--hypothesis-seed=0",
            f"@{names}",
        ]
        try:
            ended = subprocess.run(
                command, cwd=self.path, env=self.environment(pure=pure), timeout=limit_s,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return Verdict.ENDLESS
        return Verdict.KILLED if ended.returncode else Verdict.SURVIVED
