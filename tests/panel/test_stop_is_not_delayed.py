"""STOP waits for nothing that may be slow: calls that are held up do not hold it up."""

import threading
from collections.abc import Callable
from typing import Any

import httpx
import pytest
from tests.panel.bench import LIMIT_S, Client, HandStation, Served
from tests.panel.test_socket import talk

from openacr.cnc import dxf
from openacr.cnc.dxf import reading
from openacr.panel.control.operator import rehearsals
from openacr.panel.control.operator.orders import Order
from openacr.panel.server import api
from openacr.panel.server.calls import (
    ballscrew,
    configure,
    on_card,
    parts,
    programs,
)
from openacr.panel.server.calls import (
    help as helping,
)

TOML = {"name": "configure.toml", "text": "[card]\nmodel = 'ACR9000'\n"}
SETUP = {"name": "setup.8k", "text": "SYS\n"}
SLOW: list[tuple[object, str, str, str, dict[str, Any]]] = [
    (configure, "parse_answers", "POST", "/configure/read", {"json": TOML}),
    (configure, "recovered", "POST", "/configure/read", {"json": SETUP}),
    (configure, "checked", "POST", "/configure/code", {"json": {"answers": {}}}),
    (ballscrew, "parse", "POST", "/ballscrew/check", {"json": {"axis": 0, "text": "X1E.001"}}),
    (helping, "document", "GET", "/openapi.json", {}),
    (on_card, "version_of", "GET", "/card/listing", {"params": {"program": 3}}),
    (on_card, "ladder", "GET", "/card/ladder", {"params": {"plc": 0}}),
    (parts, "ready", "POST", "/parts/rect/path", {"json": {}}),
    (reading, "layers_of", "GET", "/dxf/layers", {"params": {"path": "plate.nc"}}),
    (dxf, "convert", "POST", "/dxf", {"json": {"path": "plate.nc", "output": "new.nc"}}),
    (programs, "version_of", "GET", "/programs/file", {"params": {"path": "plate.nc"}}),
    (programs, "_settle", "PUT", "/programs/file", {"params": {"path": "b.nc"}, "content": "M2"}),
    (api, "_encoded", "GET", "/help", {}),
]  # fmt: skip


@pytest.fixture
def panel(kept_panel: Served) -> Served:
    return kept_panel


@pytest.mark.parametrize(
    ("module", "name", "method", "path", "more"), SLOW, ids=[f"{row[3]} {row[1]}" for row in SLOW]
)
def test_a_call_that_is_held_up_does_not_hold_up_stop(
    panel: Served,
    monkeypatch: pytest.MonkeyPatch,
    module: object,
    name: str,
    method: str,
    path: str,
    more: dict[str, Any],
) -> None:
    has_begun, is_free = threading.Event(), threading.Event()

    def held(*_args: object, **_more: object) -> Any:
        has_begun.set()
        assert is_free.wait(LIMIT_S)
        return []

    def call() -> None:
        with httpx.Client(base_url=panel.url, timeout=2 * LIMIT_S) as web:
            web.request(method, f"/api{path}", **more)

    monkeypatch.setattr(module, name, held)
    caller = threading.Thread(target=call)

    async def scene(client: Client) -> None:
        caller.start()
        assert has_begun.wait(LIMIT_S)
        answer = await client.do("stop.hold")
        assert answer == {"id": 1, "ok": True, "result": {"stopped": []}}
        assert not is_free.is_set()

    try:
        talk(panel, scene)
    finally:
        is_free.set()
        caller.join(LIMIT_S)


def test_a_log_in_that_is_held_up_does_not_hold_up_stop(
    panel: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    accounts = panel.panel.accounts
    body = {"role": "view", "password": "x"}
    row = (type(accounts), "is_right", "POST", "/login", {"json": body})
    test_a_call_that_is_held_up_does_not_hold_up_stop(panel, monkeypatch, *row)


LONG = "".join(f"X{n % 50} Y{n % 40}\n" for n in range(3000))


def begun(hand: HandStation, answer: Callable[[dict[str, Any]], None]) -> None:
    """Begin the rehearsal of a late line; one step passes."""
    (hand.installation.programs / "long.nc").write_text(f"G21 G90 G1 F1000\n{LONG}M2\n")
    hand.do("program.load", path="long.nc")
    args = {"line": 2900, "safe_z": 0.0}
    hand.station.order(Order(hand.me, "run.begin", args, hand.now_s, answer), hand.now_s)
    hand.run(0.002)


def test_a_stop_comes_between_two_lines_of_a_rehearsal(
    hand: HandStation,
) -> None:
    answers: list[dict[str, Any]] = []
    begun(hand, answers.append)
    hand.do("stop.hold")
    assert answers == []
    hand.until(lambda: bool(answers))
    assert answers[0]["result"]["rehearsal"]["line"] == 2900


def test_lines_are_not_read_while_a_stop_waits(hand: HandStation) -> None:
    answers: list[dict[str, Any]] = []
    hand.station.link.is_awaited = lambda: True
    begun(hand, answers.append)
    hand.run(0.2)
    assert answers == []
    hand.station.link.is_awaited = lambda: False
    hand.until(lambda: bool(answers))
    assert answers[0]["ok"]


@pytest.mark.parametrize("change", ["moved", "loaded"])
def test_a_rehearsal_ends_when_the_machine_or_the_program_is_another_one(
    hand: HandStation, change: str
) -> None:
    answers: list[dict[str, Any]] = []
    begun(hand, answers.append)
    assert "are being read" in hand.refused("run.begin", line=2)["text"]
    if change == "moved":
        hand.do("mdi.execute", line="G91 G1 X10 F100")
    else:
        hand.do("program.close")
    hand.until(lambda: bool(answers))
    assert not answers[0]["ok"]
    assert rehearsals.AT_ONCE < 2900
