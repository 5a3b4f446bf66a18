"""Decisions carry a number, a date and a status, and the index lists them all."""

import re
from datetime import date
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "docs" / "decisions"
HEAD = re.compile(
    r"# (?P<title>.+)\n\n\*\*Number:\*\* (?P<number>\d+) · \*\*Date:\*\* (?P<date>[\d-]+) · "
    r"\*\*Status:\*\* (?P<status>accepted|superseded by (?P<by>\d+))"
)


def test_every_decision_has_its_number_date_and_status_and_is_in_the_index() -> None:
    rows = []
    for path in sorted(FOLDER.glob("[0-9]*.md")):
        head = HEAD.match(path.read_text())
        assert head is not None, path.name
        number = int(head["number"])
        assert path.name.startswith(f"{number:04d}-")
        assert date.fromisoformat(head["date"]) <= date.today()
        assert head["by"] is None or list(FOLDER.glob(f"{int(head['by']):04d}-*.md"))
        rows.append(
            f"| {number} | [{head['title']}]({path.name}) | {head['date']} | {head['status']} |"
        )
    assert [int(row.split()[1]) for row in rows] == list(range(1, len(rows) + 1))
    index = (FOLDER / "README.md").read_text()
    assert [line for line in index.splitlines() if re.match(r"\| \d", line)] == rows
    assert {path.name for path in FOLDER.iterdir()} == {
        "README.md", *(path.name for path in FOLDER.glob("[0-9]*-*.md")),
    }  # fmt: skip


def test_a_link_to_a_decision_leads_there_and_has_its_number() -> None:
    pages = [*FOLDER.parent.rglob("*.md"), *(FOLDER.parents[1].glob("*.md"))]
    links = re.compile(r"\[(?P<text>[^\]]*)\]\((?P<path>[^)]*\b(?P<number>\d{4})-[a-z0-9-]+\.md)\)")
    found = [(page, link) for page in pages for link in links.finditer(page.read_text())]
    assert len(found) > 100
    for page, link in found:
        assert (page.parent / link["path"]).is_file(), f"{page.name}: {link['path']}"
        numbers = re.fullmatch(r"(?:decision )?(\d+)", link["text"])
        assert numbers is None or int(numbers[1]) == int(link["number"]), f"{page.name}: {link[0]}"
