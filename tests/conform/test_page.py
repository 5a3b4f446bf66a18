"""docs/conformance.md: its examples hold, and it names every step there is."""

import re
import tomllib
from pathlib import Path

import pytest

from openacr.basic.language.registry import commands
from openacr.conform import read, report, run
from openacr.conform.form import WORDS
from openacr.conform.pages import NO_CASE, SCREENS, claims, sections, table

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


def test_the_table_of_cases_is_that_of_the_files() -> None:
    assert (ROOT / "docs" / "cases.md").read_text() == table(ROOT / "conformance"), "make docs"


def test_a_page_of_a_section_has_its_cases_as_they_are_written() -> None:
    pages = dict(sections(ROOT / "conformance"))
    assert len(pages) == len(list((ROOT / "conformance").glob("*/*.txt")))
    text = (ROOT / "conformance" / "programmers-guide" / "10-aliases.txt").read_text()
    page = pages["programmers-guide/10-aliases.md"]
    assert page.startswith("# Aliases\n")
    lines = [line for line in text.splitlines() if line and not line.startswith(("#", "[case"))]
    assert [line for line in lines if line not in page] == []
    assert page.count("\n## ") == page.count("```text") == text.count("[case ")


def test_an_id_counts_for_what_its_strongest_case_rests_on(tmp_path: Path) -> None:
    folder = tmp_path / "acromill"
    folder.mkdir()
    kinds = ("inferred: a reading", "manual", "oracle: a sum", "client: a host")
    (folder / "05-format.txt").write_text(
        "# Format\n"
        + "".join(
            f"[case {n}]\nproves: A-{n % 2}, B-{n}\nsource: 003 L1\nrests on: {kind}\n> ?1\n1\n"
            for n, kind in enumerate(kinds)
        )
    )
    assert "| Format | 4 | 6 | 2 | 2 | 1 | 1 |" in table(tmp_path)


def test_a_screen_is_proved_by_the_tests_in_a_browser_that_claim_its_id(tmp_path: Path) -> None:
    (tmp_path / "conformance").mkdir()
    folder = tmp_path / SCREENS
    folder.mkdir(parents=True)
    (folder / "test_keys.py").write_text(
        'IDS = ("A-2", "A-1")\n\n\n@pytest.mark.req(*IDS)\n@pytest.mark.req("B-1", *("B-2",))\n'
        'def test_one() -> None: ...\n\n\n@other("A-9")\n@pytest.mark.req("A-2")\n'
        "def test_two() -> None: ...\n"
    )
    assert claims(folder) == {
        "A-1": ["test_keys.py::test_one"],
        "A-2": ["test_keys.py::test_one", "test_keys.py::test_two"],
        "B-1": ["test_keys.py::test_one"],
        "B-2": ["test_keys.py::test_one"],
    }
    page = table(tmp_path / "conformance")
    assert "\n| A-2 | `test_keys.py::test_one`, `test_keys.py::test_two` |\n" in page
    assert "## Screens" not in table(tmp_path / "not" / "there")


@pytest.mark.parametrize(
    ("name", "entry"), tomllib.loads((ROOT / "conformance" / NO_CASE).read_text()).items()
)
def test_what_is_no_case_has_a_reason_and_a_test_that_exists(
    name: str, entry: dict[str, str]
) -> None:
    assert entry.keys() <= {"reason", "test"}
    assert len(entry["reason"]) > 10
    if "test" not in entry:  # nothing here can show it
        return
    file, _, function = entry["test"].partition("::")
    source = (ROOT / file).read_text()
    assert f"def {function.partition('[')[0]}(" in source
    assert f'"{name}"' in source, "the test does not claim it"
