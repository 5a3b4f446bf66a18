"""docs/conformance.md: its examples hold, and it names every step there is."""

import re
from pathlib import Path

import pytest

from openacr.basic.language.registry import commands
from openacr.conform import read, report, run
from openacr.conform.form import WORDS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "conformance.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```text\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("number", range(2))
def test_an_example_of_the_page_holds(number: int, tmp_path: Path) -> None:
    (tmp_path / "machines").symlink_to(ROOT / "conformance" / "machines")
    path = tmp_path / "cases.txt"
    path.write_text(EXAMPLES[number], encoding="utf-8")
    for case in read(path):
        difference = run(case)
        assert difference is None, report(case, difference)


# The groups of commands as names of files: axis-limits, character-io.
GROUPS = {re.sub(r"[^a-z-]", "", each.group.lower().replace(" ", "-")) for each in commands()}


def test_the_page_names_the_begin_of_every_step() -> None:
    shown = re.findall(r"`([^`]+)`", "".join(re.findall(r"^\| (`.*?) \|", PAGE, re.MULTILINE)))
    shown = [each.replace("\\", "") for each in shown]
    begins = {re.split(r" ?[A-Z]{3}|:", word.form)[0].rstrip() for word in WORDS} - {""}
    assert len(begins) > 15
    assert [begin for begin in begins if not any(each.startswith(begin) for each in shown)] == []
    assert any(each.startswith("P00> ") for each in shown)


def test_every_file_of_cases_has_a_number_and_name_of_the_page() -> None:
    for path in (ROOT / "conformance").glob("*/*.txt"):
        number, _, name = path.stem.partition("-")
        if number == "20" and path.parent.name == "programmers-guide" and name in GROUPS:
            continue
        row = next(line for line in PAGE.splitlines() if line.startswith(f"| `{path.parent.name}`"))
        assert f" {number} {name}" in row, path
