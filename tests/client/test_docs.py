"""The snippets of docs/client.md run."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.io.served import LOOPBACK, Served, serving

from openacr.client import Card

ROOT = Path(__file__).parents[2]
SNIPPETS = re.findall(
    r"^```python\n(.*?)^```", (ROOT / "docs/client.md").read_text(encoding="utf-8"), re.M | re.S
)


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    with serving() as served:
        yield served


@pytest.mark.parametrize("number", range(len(SNIPPETS)))
def test_a_snippet_of_the_manual_runs(
    served: Served, number: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    target = f"{LOOPBACK}:{served.ascii_port}"
    with Card.open(target) as card:
        exec(
            compile(SNIPPETS[number], f"snippet {number}", "exec"), {"target": target, "card": card}
        )
    assert "Traceback" not in capsys.readouterr().out


def test_the_manual_has_its_snippets() -> None:
    assert len(SNIPPETS) >= 8
