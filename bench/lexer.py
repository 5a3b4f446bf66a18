"""Lines of controller files read per second: tokens alone, and whole trees."""

from pathlib import Path

from bench.cards import ROOT
from bench.figures import best_s, value_only
from openacr.basic.language.loader import file_lines
from openacr.controller import Controller
from openacr.lang.lexer import tokens

REPEAT = 20


def _lines() -> list[str]:
    files = sorted(Path(ROOT, "examples").glob("*/*.8k"))
    return [line.text for file in files for line in file_lines(file.read_text())] * REPEAT


def main() -> None:
    lines = _lines()
    seconds = best_s(lambda: [tokens(line) for line in lines])
    value_only("lines split into tokens per second", len(lines) / seconds, "1/s")
    projects = sorted(path.parent for path in ROOT.glob("examples/*/setup.8k"))
    files = [file for project in projects for file in project.glob("*.8k")]
    count = sum(len(list(file_lines(file.read_text()))) for file in files)
    seconds = best_s(lambda: [Controller.from_project(project) for project in projects], 3)
    value_only("lines loaded into a card per second", count / seconds, "1/s")


if __name__ == "__main__":
    main()
