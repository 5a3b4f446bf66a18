"""The snippets of the pages for hosts run."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.io.served import LOOPBACK, Served, serving

from openacr.client import Card

ROOT = Path(__file__).parents[2]
PAGES = ("client.md", "host-software.md")
SNIPPETS = [
    (page, snippet)
    for page in PAGES
    for snippet in re.findall(
        r"^```python\n(.*?)^```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.M | re.S
    )
]


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    with serving("--status-port", "0") as served:
        yield served


@pytest.mark.parametrize("number", range(len(SNIPPETS)))
def test_a_snippet_of_the_manual_runs(
    served: Served, number: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    target = f"{LOOPBACK}:{served.ascii_port}"
    page, snippet = SNIPPETS[number]
    with Card.open(target) as card:
        names = {"target": target, "card": card, "host": LOOPBACK}
        names |= {"binary_port": served.binary_port, "status_port": served.status_port}
        exec(compile(snippet, f"snippet of {page}", "exec"), names)
    assert "Traceback" not in capsys.readouterr().out


def test_the_manual_has_its_snippets() -> None:
    counts = {page: sum(page == each for each, _ in SNIPPETS) for page in PAGES}
    assert all(count >= 7 for count in counts.values())
