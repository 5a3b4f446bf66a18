"""A command of the panel is one function, as in the piece of docs/adding-a-panel-command.md."""

import html
import inspect
import json
import re
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from tests.panel.bench import HandStation, Served

from openacr.panel.commands import registry
from openacr.panel.commands.all import COMMANDS
from openacr.panel.commands.registry import NEEDS, command

TEXT = (Path(__file__).parents[2] / "docs/adding-a-panel-command.md").read_text(encoding="utf-8")
PIECE = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)[0]
TITLES = re.compile(r'<meta name="titles" content="([^"]*)">')


@pytest.fixture
def own_commands() -> Iterator[None]:
    """Commands that a test declares are forgotten after it."""
    before = dict(COMMANDS)
    yield
    COMMANDS.clear()
    COMMANDS.update(before)


@pytest.fixture
def piece(own_commands: None) -> None:
    exec(compile(PIECE, "piece of adding-a-panel-command.md", "exec"), {"__name__": "piece"})


@pytest.fixture
def web(kept_panel: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=kept_panel.url, timeout=60.0) as client:
        yield client


def test_one_function_makes_a_command_with_checked_arguments(
    piece: None, hand: HandStation
) -> None:
    assert hand.do("spindle.warm", seconds=2.0) == {"seconds": 2.0}
    hand.run(0.5)
    assert hand.station.typed.data()["running"]
    assert "warmed up at rest" in hand.refused("spindle.warm")["text"]
    for wrong in ({"seconds": 600.5}, {"seconds": "2"}, {"hours": 1.0}):
        assert hand.refused("spindle.warm", **wrong)["code"] == "bad"
    hand.do("stop.all")


def test_the_same_function_makes_its_call_its_description_its_help_and_its_texts(
    piece: None, web: httpx.Client
) -> None:
    refused = web.post("/api/commands/spindle.warm", json={"seconds": 0.0})
    assert (refused.status_code, refused.json()["error"]["code"]) == (400, "bad")
    described = web.get("/api/openapi.json").json()
    assert described["x-commands"]["spindle.warm"] == {
        "summary": "Let the spindle turn for a time.",
        "titles": {"en": "WARM UP", "de": "WARMLAUFEN"},
        "role": "operate",
        "needs_control": True,
        "args": {"$ref": "#/components/schemas/SpindleWarm"},
    }
    seconds = described["components"]["schemas"]["SpindleWarm"]["properties"]["seconds"]
    assert seconds == {"type": "number", "exclusiveMinimum": 0, "maximum": 600, "default": 60.0}
    posted = described["paths"]["/api/commands/spindle.warm"]["post"]
    assert posted["summary"] == "Let the spindle turn for a time."
    keys = web.get("/api/help").json()["keys"]
    assert (keys["warmup"], keys["spindle.warm"]) == ("WARM UP", "WARM UP")
    page = web.get("/api/help/warmup").json()
    assert page["text"] == "The spindle turns for some time, so that it is warm."
    other = web.get("/api/help/warmup", params={"language": "de"}).json()
    assert other == {
        "title": "WARMLAUFEN",
        "text": "Die Spindel dreht eine Weile, damit sie warm ist.",
    }
    assert web.get("/api/help?language=de").json()["keys"]["spindle.warm"] == "WARMLAUFEN"
    found = TITLES.search(web.get("/").text)
    assert found is not None
    titles = json.loads(html.unescape(found[1]))
    assert titles["spindle.warm"] == {"en": "WARM UP", "de": "WARMLAUFEN"}


def test_a_command_over_http_is_carried_out_and_leaves_control_free(
    kept_panel: Served, web: httpx.Client
) -> None:
    done = web.post("/api/commands/zero.blocks", json={"axes": "X"})
    assert (done.status_code, list(done.json())) == (200, ["blocks"])
    assert web.post("/api/commands/overrides").status_code == 400
    chosen = web.post("/api/commands/override.choose", json={"which": "feed", "click": 4})
    assert chosen.status_code == 200
    people = kept_panel.call(lambda station: station.people.data())
    assert people["holder"] is None
    assert people["clients"] == []
    web.post("/api/commands/override.choose", json={"which": "feed", "click": 10})


@pytest.mark.parametrize("body", ["[]", "{", "3"])
def test_arguments_that_are_no_object_are_refused(web: httpx.Client, body: str) -> None:
    refused = web.post("/api/commands/jog.stop", content=body)
    assert (refused.status_code, refused.json()["error"]["code"]) == (400, "bad")


def test_a_key_that_is_pressed_over_http_ends_with_the_call(
    kept_panel: Served, web: httpx.Client
) -> None:
    tick = kept_panel.call(lambda station: station.snapshot.tick_ms)
    args = {"press": 1, "axis": "X", "direction": 1, "tick": tick, "first": True}
    web.post("/api/commands/jog.press", json=args)
    assert not kept_panel.call(lambda station: station.hand_motion.presses.are_held)


def test_a_name_twice_and_a_title_in_one_language_are_refused(own_commands: None) -> None:
    with pytest.raises(ValueError, match=r"two commands 'jog\.stop'"):
        command("jog.stop")(lambda: None)
    for en, de in (("", "ANDERS"), ("OTHER", "")):
        with pytest.raises(ValueError, match="every language"):
            command("jog.other", en=en, de=de)


def test_every_command_needs_only_what_a_station_has(hand: HandStation) -> None:
    assert len(COMMANDS) > 80
    for row in COMMANDS.values():
        kinds = inspect.signature(row.do, eval_str=True).parameters
        for name in row.needs:
            assert name in NEEDS or hasattr(hand.station, name), (row.name, name)
            kind = kinds[name].annotation
            if name not in NEEDS and isinstance(kind, type) and kind is not float:
                assert isinstance(getattr(hand.station, name), kind), (row.name, name)


def test_the_page_names_what_there_is() -> None:
    table = TEXT.partition("## The decorator")[2]
    words = re.findall(r"^\| `(\w+)(?:=\w+)?`(?:, `(\w+)`)?", table, re.M)
    known = inspect.signature(registry.command).parameters
    assert {word for pair in words for word in pair if word} <= set(known)
    assert len(words) >= 5
