"""The documentation site: its table of contents names every page."""

from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_every_page_is_in_the_table_of_contents() -> None:
    named = set((ROOT / "site" / "index.md").read_text().splitlines())
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")}
    assert pages - named == set()
    assert {"decisions/README", "reference/README", "api"} <= named
