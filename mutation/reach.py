"""Which tests run a line and how long each takes, measured: coverage with a context per test."""

import subprocess
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import coverage

from mutation.trial import Tree

# Folders of tests that hold a package, where it is not the folder of its own name alone.
FOLDERS = {
    "kernel": ("kernel", "engine", "motion"),
    "motion": ("motion",),
    "engine": ("engine", "kernel"),
    "controller": ("controller", "protocol", "system"),
    "mill": ("mill",),
    "cli": ("cli",),
    "lang": ("lang", "basic"),
    "store": ("store", "controller"),
    "io": ("io", "system"),
}


@dataclass(frozen=True)
class Reach:
    """Tests by place: `lines[path, line]` and `files[path]` name node ids; seconds of each test."""

    lines: dict[tuple[str, int], set[str]]
    files: dict[str, set[str]]
    seconds: dict[str, float]

    def tests_of(self, path: str, line: int, within_s: float) -> list[str]:
        """Tests of a line, or else of its file: the quickest, as many as run within a time."""
        reached = self.lines.get((path, line)) or self.files.get(path, set())
        chosen: list[str] = []
        total_s = 0.0
        for test in sorted(reached, key=lambda test: (self.seconds.get(test, 0.0), test)):
            total_s += self.seconds.get(test, 0.0)
            if chosen and total_s > within_s:
                break
            chosen.append(test)
        return chosen


def folders_of(paths: list[str]) -> list[str]:
    """The cases of the manuals, and the folders of tests that hold the packages of some files."""
    packages = dict.fromkeys(Path(path).parts[2].removesuffix(".py") for path in paths)
    names = dict.fromkeys(name for package in packages for name in FOLDERS.get(package, (package,)))
    found = [f"tests/{name}" for name in names if Path("tests", name).is_dir()]
    return [*(["conformance"] if Path("conformance").is_dir() else []), *(found or ["tests"])]


def measure(tree: Tree, folders: list[str], *, pure: bool, workers: int) -> Reach:
    """Run the tests once in a copy of the tree, unbroken; they must pass."""
    data = tree.path / ".coverage"
    times = tree.path / "durations.txt"
    arguments = [
        *folders, "-p", "no:openacr", "-m", "not soak", "-n", str(workers), "--cov=openacr",
        "--cov-context=test", "--cov-report=", "--durations=0", "--durations-min=0",
        "--timeout=600",
    ]  # fmt: skip
    with times.open("w") as output:
        ended = subprocess.run(
            [sys.executable, "-m", "pytest", *arguments],
            cwd=tree.path, env=tree.environment(pure=pure), stdout=output, stderr=subprocess.STDOUT,
        )  # fmt: skip
    text = times.read_text()
    if ended.returncode:
        raise SystemExit(f"mutation: tests fail without a mutant:\n{text[-3000:]}")
    return Reach(*_by_place(data, tree.path), _seconds(text))


def _seconds(text: str) -> dict[str, float]:
    """Seconds of set-up, call and tear-down of each test, from the table pytest prints."""
    total: dict[str, float] = defaultdict(float)
    for line in text.splitlines():
        words = line.split(maxsplit=2)
        if len(words) == 3 and words[1] in ("setup", "call", "teardown") and words[0].endswith("s"):
            total[words[2]] += float(words[0][:-1])
    return dict(total)


def _by_place(
    path: Path, root: Path
) -> tuple[dict[tuple[str, int], set[str]], dict[str, set[str]]]:
    data = coverage.CoverageData(str(path))
    data.read()
    lines: dict[tuple[str, int], set[str]] = {}
    files: dict[str, set[str]] = {}
    for file in data.measured_files():
        name = str(Path(file).relative_to(root))
        for line, contexts in data.contexts_by_lineno(file).items():
            tests = {context.rpartition("|")[0] for context in contexts if context}
            lines[name, line] = tests
            files.setdefault(name, set()).update(tests)
    return lines, files
