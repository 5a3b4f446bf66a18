"""What docs/bridges.md shows: its files are bridges, its table of values is that of the program."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from tests.bridge.bench import VALUES, GivenFeed, bridged, url
from tests.waiting import LIMIT_S, until

from openacr.bridge.load import parse_bridge
from openacr.bridge.rows import AXIS_ROWS, ROWS, Row

PORTS = {"prometheus": 9780, "mtconnect": 5000, "opcua": 4840}  # of the examples
PAGE = Path(__file__).parents[2] / "docs" / "bridges.md"
TEXT = PAGE.read_text(encoding="utf-8")


def line_of(row: Row, prefix: str) -> str:
    standard = row.standard
    known = ""
    if standard is not None:
        known = f"{standard.type} {standard.sub}".strip()
    unit = row.unit.lower()
    return f"| `{prefix}{row.name}` | {row.meaning} | {row.kind} | {unit} | {known} |"


def test_the_page_lists_every_value_as_the_table_has_it() -> None:
    lines = [*(line_of(row, "") for row in ROWS), *(line_of(row, "X.") for row in AXIS_ROWS)]
    assert "\n".join(lines) in TEXT, "\n".join(lines)


def test_every_file_of_the_page_is_a_bridge() -> None:
    files = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    assert files
    for text in files:
        parse_bridge(text)
        assert tomllib.loads(text)


@pytest.fixture(scope="module")
def text() -> Iterator[str]:
    """The page with the addresses of a bridge that runs."""
    tables = "".join(f"[{name}]\nport = 0\n" for name in PORTS)
    with bridged(f'name = "mill"\nrate_hz = 20\n{tables}{VALUES}', GivenFeed()) as bridge:
        text = TEXT
        for name, port in PORTS.items():
            real = url(bridge, name).split(":")[2].split("/")[0]
            text = text.replace(f"127.0.0.1:{port}", f"127.0.0.1:{real}")
        metrics = url(bridge, "prometheus")
        until(lambda: "openacr_line" in httpx.get(metrics, timeout=LIMIT_S).text)
        yield text


def test_every_address_of_the_page_answers(text: str) -> None:
    places = re.findall(r"^curl '?(http[^'\n]+)'?$", text, re.MULTILINE)
    assert len(places) == 4
    for place in places:
        assert httpx.get(place, timeout=LIMIT_S).status_code == 200, place
    shown = re.findall(r"^openacr_\S+\{.*$", text, re.MULTILINE)
    metrics = httpx.get(places[0], timeout=LIMIT_S).text.splitlines()
    assert len(shown) == 5
    assert set(shown) <= set(metrics)


def test_the_host_of_the_page_reads_a_value(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(code, {})
    assert capsys.readouterr().out == "80.0\n"
