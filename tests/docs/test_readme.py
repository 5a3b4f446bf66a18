"""What the README tells a new user to do really works."""

import re
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests import warm

ROOT = Path(__file__).parents[2]
PROMPT = re.compile(r"(?:SYS|P\d\d)>")


def blocks(language: str) -> list[str]:
    """The code blocks of the README in one language."""
    text = (ROOT / "README.md").read_text()
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands() -> list[list[str]]:
    """The commands of the tour, without their remarks."""
    lines = (line for block in blocks("") for line in block.splitlines())
    return [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("openacr ")]


def is_interactive(words: list[str]) -> bool:
    """Whether a command waits for input."""
    return words[0] in ("serve", "term", "lsp")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An empty folder with the examples in it."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    return tmp_path


def test_the_tour_shows_all_kinds_of_commands() -> None:
    assert {words[0] for words in commands()} >= {"run", "serve", "term", "param", "check", "list"}


@pytest.mark.parametrize("words", [c for c in commands() if not is_interactive(c)], ids=" ".join)
def test_a_command_of_the_tour_works(folder: Path, words: list[str]) -> None:
    result = warm.run(words, cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert result.stdout.strip()
    for option in ("--plot", "--summary", "--trace"):
        if option in words:
            assert (folder / words[words.index(option) + 1]).stat().st_size > 0


@pytest.fixture
def served(folder: Path) -> Iterator[str]:
    """The card of the tour on a free port."""
    (words,) = (c for c in commands() if c[0] == "serve")
    project = words[1]
    command = ["serve", project, "--ascii-port", "0", "--binary-port", "0"]
    with warm.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield process.stdout.readline().split("ascii=")[1].split()[0]
        process.terminate()
        assert process.wait(60) == 0


def test_the_conversation_of_the_tour_takes_place(served: str) -> None:
    (block,) = (block for block in blocks("") if PROMPT.match(block))
    shown = [PROMPT.sub("", line) for line in block.splitlines()]
    typed = [PROMPT.sub("", line) for line in block.splitlines() if PROMPT.match(line)]
    result = warm.run(
        ["term", served], input="\n".join(typed) + "\n", capture_output=True, text=True, check=True
    )
    lines = iter(PROMPT.sub("", line).rstrip() for line in result.stdout.splitlines())
    for line in shown:
        assert line in lines, f"{line!r} is not in {result.stdout!r}"


@pytest.mark.parametrize("code", blocks("python"))
def test_the_python_of_the_readme_runs(
    folder: Path, code: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    exec(compile(code, "README.md", "exec"), {"__name__": "__main__"})


def planned(target: str) -> str:
    """What make would do, said without doing it."""
    make = shutil.which("make")
    if make is None:
        pytest.skip("make is not installed")
    always = ["--always-make", "--dry-run", "--no-print-directory"]
    result = subprocess.run(
        [make, *always, target], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return result.stdout


def test_make_demo_runs_the_example_it_promises() -> None:
    plan = planned("demo")
    assert "openacr run examples/gantry --for 60 --plot out/gantry.png" in plan
    assert plan.index("-m venv") < plan.index("build_ext") < plan.index("openacr run")


def test_make_test_checks_everything_and_runs_the_tests() -> None:
    plan = planned("test")
    steps = ("-m venv", "build_ext", "ruff check", "ruff format --check", "mypy", "lint-imports")
    places = [plan.index(step) for step in (*steps, "-m pytest")]
    assert places == sorted(places)


def test_continuous_integration_does_what_a_developer_does() -> None:
    script = (ROOT / ".ci" / "run").read_text().strip().splitlines()
    assert script[0].startswith("#!")
    assert script[-1] == "exec make test"
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111
    assert "make test" in "".join(blocks(""))
