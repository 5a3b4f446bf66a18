"""The reference pages say what the registry says."""

from pathlib import Path

import pytest

from openacr.basic.commands.operating_system import help_words
from openacr.basic.language import registry
from openacr.basic.language.written import levels, reports, syntax
from openacr.basic.reference import examples_of, groups, pages, slug, title
from openacr.map import flags, parameters
from openacr.messages import MESSAGES

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "reference"
PAGES = pages(examples_of(ROOT / "examples"))


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_up_to_date(name: str) -> None:
    assert (FOLDER / name).read_text() == PAGES[name], "run `make docs`"


def test_no_page_is_left_over() -> None:
    assert {path.name for path in FOLDER.glob("*.md")} == {*PAGES, "plc.md"}


def test_every_command_has_its_place_syntax_and_sentence() -> None:
    for group, rows in groups().items():
        page = PAGES[f"{slug(group)}.md"]
        for row in rows:
            assert f"\n## {title(row)}\n\n{row.summary}" in page
            assert f"* Written: `{syntax(row)}`" in page
            assert row.summary.endswith("."), row


def test_every_function_and_message_is_on_a_page() -> None:
    assert all(f"`{name}" in PAGES["functions.md"] for name in registry.functions)
    texts = [message.text.format("...") for message in MESSAGES.values() if message.text]
    assert all(f"`{text}`" in PAGES["messages.md"] for text in texts)


def test_every_section_of_the_map_is_on_its_page() -> None:
    sections = {row.section for row in parameters().values()}
    sections |= {row.section for row in flags().values()}
    assert all(f"| {section} |" in PAGES["parameters.md"] for section in sections)


def test_help_lists_the_commands_of_the_pages() -> None:
    shown = " ".join(PAGES["README.md"].split())
    assert all(word.lstrip("#") in shown for word in help_words() if word != "REM")


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("JOG VEL", "JOG VEL {axis {value} ...}"),
        ("EXC", "EXC axis {value|(plus,minus)} ..."),
        ("ENC # RES", "ENCn RES {position}"),
        ("FOR", "FOR variable = first TO last {STEP expr}"),
        ("CIRCW", "CIRCW axis(target,center) ..."),
        ("TRG OFF", "TRG OFF"),
    ],
)
def test_syntax_is_derived_from_the_row(name: str, written: str) -> None:
    assert syntax(registry.find(name)) == written


def test_levels_and_queries_are_put_in_words() -> None:
    assert levels(registry.find("WEND")) == "PROG; stored only"
    assert levels(registry.find("ESAVE")).startswith("SYS")
    assert reports(registry.find("ACC"))
    assert not reports(registry.find("DWL"))
