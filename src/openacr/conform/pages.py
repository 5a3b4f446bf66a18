"""The cases as pages: `python -m openacr.conform.pages FILE [FOLDER]`.

FILE gets the table of all sections: how many cases each has, how many ids they prove and what they
rest on; then the ids that tests of the screens prove, and those with a test of their own. FOLDER
gets a page for each section with the text of its cases.
"""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from openacr.conform.form import Case
from openacr.conform.read import RESTS, files, read, supplied

MANUALS = {
    "programmers-guide": "Programmer's Guide",
    "users-guide-2": "User's Guide Part 2",
    "acromill": "Front end's User's Guide",
}
NO_CASE = "not-a-case.toml"
SCREENS = "tests/panel/browser"  # beside the folder of the manuals, in the source tree alone
HEAD = """\
# The cases of the manuals

Made by `make docs` of `conformance/`; [conformance.md](conformance.md) says how a case is written,
and how a card is asked. A row of a table counts as a case. An id counts for what its strongest case
rests on: the text of the manual, a computation that shares nothing with openacr (oracle), a host
that works with real cards (client), or this project's reading (inferred).
"""
_CASES = re.compile(r"^\[case (.+)\]$", re.MULTILINE)
_TITLE = re.compile(r"^# (.+)$", re.MULTILINE)


def table(root: Path) -> str:
    """The page of all sections."""
    lines = [HEAD]
    every: list[Case] = []
    for manual, title in MANUALS.items():
        sections = {path: read(path) for path in files(root / manual)}
        if not sections:
            continue
        lines += [f"## {title}\n", f"| section | cases | ids | {' | '.join(RESTS)} |"]
        lines.append("|---|---|---|" + "---|" * len(RESTS))
        for path, cases in sections.items():
            lines.append(_row(_title(path), cases))
            every += cases
        lines.append("")
    lines += ["## Together\n", f"| | cases | ids | {' | '.join(RESTS)} |"]
    lines += ["|---|---|---|" + "---|" * len(RESTS), _row("all", every), ""]
    return "\n".join([*lines, *_of_screens(root.parent), *_without_case(root / NO_CASE)])


def claims(folder: Path) -> dict[str, list[str]]:
    """The ids that the tests of a folder claim (`pytest.mark.req`), each with its tests."""
    found: dict[str, list[str]] = {}
    for path in sorted(folder.rglob("test_*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        names = {
            target.id: each.value
            for each in tree.body
            if isinstance(each, ast.Assign)
            for target in each.targets
            if isinstance(target, ast.Name)
        }
        for test in ast.walk(tree):
            if isinstance(test, ast.FunctionDef):
                for name in dict.fromkeys(_claimed(test, names)):
                    found.setdefault(name, []).append(f"{path.name}::{test.name}")
    return dict(sorted(found.items()))


def _claimed(test: ast.FunctionDef, names: Mapping[str, ast.expr]) -> Iterator[str]:
    """The ids of a test's marks; `*IDS` are those of a tuple of the file."""
    for mark in test.decorator_list:
        if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "pytest.mark.req":
            for each in mark.args:
                if isinstance(each, ast.Starred):
                    yield from ast.literal_eval(names.get(ast.unparse(each.value), each.value))
                else:
                    yield ast.literal_eval(each)


def _of_screens(tree: Path) -> Iterator[str]:
    """The table of what tests of the screens prove."""
    found = claims(tree / SCREENS)
    if not found:
        return
    yield "## Screens\n"
    yield (
        "What a screen shows and does is no dialogue with a card: tests in a browser prove it, on a"
        f" panel with a virtual mill (`{SCREENS}`).\n"
    )
    yield "| id | tests |"
    yield "|---|---|"
    for name, tests in found.items():
        yield f"| {name} | {', '.join(f'`{each}`' for each in tests)} |"
    yield ""


def _without_case(path: Path) -> Iterator[str]:
    """The table of what no case proves."""
    if not path.exists():
        return
    yield "## No case\n"
    yield "| id | why | test |"
    yield "|---|---|---|"
    for name, entry in tomllib.loads(path.read_text(encoding="utf-8")).items():
        test = f"`{entry['test']}`" if "test" in entry else ""
        yield f"| {name} | {entry['reason']} | {test} |"
    yield ""


def _row(title: str, cases: Sequence[Case]) -> str:
    strongest: dict[str, int] = {}
    for case in cases:
        rank = RESTS.index(case.rests.partition(":")[0])
        for claim in case.proves:
            strongest[claim.id] = min(rank, strongest.get(claim.id, rank))
    counts = Counter(strongest.values())
    cells = (str(counts[rank] or "") for rank in range(len(RESTS)))
    return f"| {title} | {len(cases)} | {len(strongest)} | {' | '.join(cells)} |"


def _title(path: Path) -> str:
    found = _TITLE.search(path.read_text(encoding="utf-8"))
    return found[1] if found else path.stem


def section(path: Path) -> str:
    """The page of one section: its cases as they are written."""
    first, *rest = _CASES.split(path.read_text(encoding="utf-8"))
    shared = "\n".join(line for line in first.splitlines() if line and not line.startswith("#"))
    lines = [f"# {_title(path)}\n"]
    lines += [f"For all of them: {shared}.\n"] if shared else []
    for name, text in zip(rest[::2], rest[1::2], strict=True):
        lines += [f"## {_plain(name)}\n", "```text", *text.strip("\n").split("\n"), "```\n"]
    return "\n".join(lines)


def _plain(name: str) -> str:
    """A name as a heading: nothing in it is a mark of the page."""
    return re.sub(r"([*_`<>\[\]{}$\\])", r"\\\1", name)


def sections(root: Path) -> Iterator[tuple[str, str]]:
    """The pages of all sections by their names."""
    for manual in MANUALS:
        for path in files(root / manual):
            yield f"{manual}/{path.stem}.md", section(path)


def contents(names: Iterable[str]) -> str:
    """A page that leads to the pages of all sections."""
    entries = "\n".join(name.removesuffix(".md") for name in names)
    return f"# Cases, section by section\n\n```{{toctree}}\n:maxdepth: 1\n{entries}\n```\n"


def main(file: str, folder: str | None = None) -> None:
    """Write the pages."""
    root = supplied()
    Path(file).write_text(table(root), encoding="utf-8")
    if folder is None:
        return
    written = list(sections(root))
    for name, text in [*written, ("index.md", contents(name for name, _ in written))]:
        path = Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
