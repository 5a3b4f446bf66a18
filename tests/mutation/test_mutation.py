"""The mutation job: what it breaks, and that it tells a tested place from an untested one."""

import subprocess
import sys
from pathlib import Path

import pytest
from mutation.changes import changed
from mutation.operators import mutants
from mutation.reach import Reach, folders_of

ROOT = Path(__file__).parents[2]

TOY = """\
def clamp(value: float, limit: float) -> float:
    return limit if value > limit else value


def loose(value: float) -> bool:
    return value >= 5.0
"""
TESTS = """\
from openacr.toy import clamp, loose


def test_clamp() -> None:
    assert [clamp(v, 2.0) for v in (1.0, 2.0, 3.0)] == [1.0, 2.0, 2.0]


def test_loose() -> None:
    assert loose(6.0) and not loose(4.0)
"""


def _texts(source: str) -> set[str]:
    return {mutant.apply(source) for mutant in mutants("x.py", source)}


@pytest.mark.parametrize(
    ("source", "broken"),
    [
        ("a < b", {"a <= b"}),
        ("a is not b", {"a is b"}),
        ("a and b and c", {"(a) or (b) or (c)", "(b) and (c)", "(a) and (c)", "(a) and (b)"}),
        ("a * (b)", {"(a) / (b)"}),
        ("x -= 1", {"x += 1", "x -= 2"}),
        ("p.x = y", {"pass"}),
        ("f(2)", {"pass", "f(3)"}),
        ("raise E", {"pass"}),
        ("max(a, b)", {"min(a, b)", "pass"}),
        ("x = not y", {"x = (y)"}),
        ("x = True", {"x = False"}),
        ("x: Literal[3] = 0.5", {"x: Literal[3] = 1.0"}),
        ('x = "text" + y', set()),
        ("_log.info(3)", {"pass"}),
        ("ä = 'ö'; x = 7", {"ä = 'ö'; x = 8"}),
    ],
)
def test_each_operator_breaks_its_place_and_nothing_else(source: str, broken: set[str]) -> None:
    assert _texts(source) == broken


def test_a_condition_that_is_a_name_is_turned_round() -> None:
    assert _texts("if ready:\n    pass\n") == {"if (not (ready)):\n    pass\n"}


def test_the_quickest_tests_of_a_line_are_chosen_within_their_time() -> None:
    seconds = {"slow": 9.0, "quick": 1.0, "middle": 2.0, "elsewhere": 0.1}
    reach = Reach({("f.py", 3): {"slow", "quick", "middle"}}, {"f.py": {"elsewhere"}}, seconds)
    assert reach.tests_of("f.py", 3, 3.0) == ["quick", "middle"]
    assert reach.tests_of("f.py", 3, 0.5) == ["quick"]
    assert reach.tests_of("f.py", 4, 3.0) == ["elsewhere"]
    assert reach.tests_of("g.py", 4, 3.0) == []


def test_every_package_has_tests_to_break_it_against() -> None:
    packages = [
        path for path in (ROOT / "src/openacr").iterdir() if (path / "__init__.py").exists()
    ]
    for package in packages:
        first, *others = folders_of([str(package.relative_to(ROOT) / "x.py")])
        assert first == "conformance"
        assert others != ["tests"], package.name


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A small project under git whose last commit added `loose`."""
    for name, text in {
        "src/openacr/__init__.py": "",
        "src/openacr/toy.py": TOY.partition("\n\n\n")[0] + "\n",
        "tests/toy/test_toy.py": TESTS,
        "pyproject.toml": "[tool.pytest.ini_options]\naddopts = '-q --import-mode=importlib'\n",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    git = ["git", "-c", "user.name=x", "-c", "user.email=x@y.z"]
    for arguments in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "one"]):
        subprocess.run([*git, *arguments], cwd=tmp_path, check=True)
    (tmp_path / "src/openacr/toy.py").write_text(TOY)
    subprocess.run([*git, "commit", "-qam", "two"], cwd=tmp_path, check=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_lines_changed_since_a_revision_are_found(repository: Path) -> None:
    assert changed("HEAD~1") == {"src/openacr/toy.py": {3, 4, 5, 6}}
    assert changed("HEAD") == {}


def test_places_that_no_test_holds_are_listed_and_fail_the_job(repository: Path) -> None:
    command = [sys.executable, "-m", "mutation", "toy.py", "--workers", "1"]
    job = {"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"}
    ended = subprocess.run(command, capture_output=True, text=True, env=job)
    assert ended.returncode == 1, ended.stderr
    lines = ended.stdout.splitlines()
    assert lines[0] == "3 mutants; measuring which tests run them: tests/toy"
    assert lines[1:] == [
        # at exactly the limit both results are the limit: the one mutant without effect
        "survived: src/openacr/toy.py:2 clamp: value > limit -> value >= limit",
        "survived: src/openacr/toy.py:6 loose: value >= 5.0 -> value > 5.0",
        "toy: 3 mutants, 2 survived (67 %)",
    ]


def test_the_same_count_of_mutants_is_drawn_from_each_package(repository: Path) -> None:
    (repository / "src/openacr/other.py").write_text(TOY)
    command = [sys.executable, "-m", "mutation", "all", "--each", "2", "--workers", "1"]
    job = {"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"}
    ended = subprocess.run(command, capture_output=True, text=True, env=job)
    assert "4 mutants;" in ended.stdout
    assert [line.partition(",")[0] for line in ended.stdout.splitlines()[-2:]] == [
        "other: 2 mutants",
        "toy: 2 mutants",
    ]
