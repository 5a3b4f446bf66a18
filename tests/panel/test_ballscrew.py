"""The ballscrew table of an axis over HTTP: read, checked, stored and switched."""

from collections.abc import Iterator

import httpx
import pytest
from tests.panel.bench import Served

from openacr.panel.roles import Role
from openacr.sysvar.tabs import OFFSETS

TEXT = "X1E.00175\nX0E.00325\nX2E-.00250\n"
ENTRIES = [[0.0, 0.00325], [1.0, 0.00175], [2.0, -0.0025]]


@pytest.fixture
def web(quiet_panel: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=quiet_panel.url) as client:
        yield client


def switched(panel: Served) -> list[int]:
    """The axes whose tables the session has put on the card."""
    panel.step(0.1)
    return panel.call(lambda station: sorted(station.link.machine.runner._compensation._axes))


def test_an_axis_without_a_table_has_no_entries_and_nothing_to_export(web: httpx.Client) -> None:
    assert web.get("/api/ballscrew", params={"axis": 1}).json() == {
        "axis": 1, "name": "Y", "axes": [{"index": n, "name": "XYZ"[n]} for n in range(3)],
        "unit": "mm", "is_on": False, "entries": [], "problem": "",
    }  # fmt: skip
    answer = web.get("/api/ballscrew/file", params={"axis": 1})
    assert answer.status_code == 404
    assert answer.json()["error"]["text"] == "axis Y has no ballscrew table"
    on = web.put("/api/ballscrew", json={"axis": 1, "is_on": True})
    assert on.json()["error"]["text"] == "axis Y has no ballscrew table: import or enter one"
    assert web.put("/api/ballscrew", json={"axis": 1, "is_on": False}).status_code == 200


def test_a_stored_table_is_in_order_is_exported_and_put_on_the_card(
    web: httpx.Client, quiet_panel: Served
) -> None:
    stored = web.put("/api/ballscrew", json={"axis": 0, "is_on": True, "text": TEXT}).json()
    assert (stored["is_on"], stored["entries"]) == (True, ENTRIES)
    assert web.get("/api/ballscrew").json() == stored
    exported = web.get("/api/ballscrew/file", params={"axis": 0})
    assert exported.text == "X0E.00325\nX1E.00175\nX2E-.00250\n"
    name = exported.headers["content-disposition"]
    assert name == 'attachment; filename="ballscrew_X.txt"'
    assert (quiet_panel.store.parent / "ballscrew_X.txt").read_text() == exported.text
    assert not list(quiet_panel.store.parent.glob("*.new"))
    assert switched(quiet_panel) == [0]
    off = web.put("/api/ballscrew", json={"axis": 0, "is_on": False}).json()
    assert (off["is_on"], off["entries"]) == (False, ENTRIES)
    assert switched(quiet_panel) == []


def test_a_new_text_of_a_table_that_is_on_already_reaches_the_card(
    web: httpx.Client, quiet_panel: Served
) -> None:
    web.put("/api/ballscrew", json={"axis": 0, "is_on": True, "text": TEXT})
    switched(quiet_panel)
    session = quiet_panel.call(lambda station: station.link.machine)
    web.put("/api/ballscrew", json={"axis": 0, "is_on": True, "text": "X0E.1\nX9E.2"})
    switched(quiet_panel)
    assert quiet_panel.call(lambda station: station.link.machine) is not session


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("X0E.1\nX0E.2", "table:2: position 0 occurs twice"),
        ("X0E.1\nY1E.2", "table:2: axis Y, but the table is that of X"),
        ("X0E.1\nX1", "table:2: 'X1' is not like X1E.00175"),
        ("", "table: 0 entries; a table needs 2"),
    ],
)
def test_a_text_that_is_no_table_is_refused_and_the_stored_one_stays(
    web: httpx.Client, quiet_panel: Served, text: str, reason: str
) -> None:
    stored = web.put("/api/ballscrew", json={"axis": 0, "is_on": True, "text": TEXT}).json()
    for answer in (
        web.post("/api/ballscrew/check", json={"axis": 0, "text": text}),
        web.put("/api/ballscrew", json={"axis": 0, "is_on": False, "text": text}),
    ):
        assert answer.status_code == 422
        assert answer.json()["error"]["text"] == reason
    assert web.get("/api/ballscrew").json() == stored


def test_a_table_that_cannot_be_read_says_why_and_can_be_replaced(
    web: httpx.Client, quiet_panel: Served
) -> None:
    quiet_panel.panel.installation.store.write_text(OFFSETS.ballscrew_file[0], "gone.txt")
    shown = web.get("/api/ballscrew").json()
    assert shown["entries"] == []
    assert shown["problem"].endswith("gone.txt: cannot be read: no such file or directory")
    web.put("/api/ballscrew", json={"axis": 0, "is_on": False, "text": TEXT})
    assert web.get("/api/ballscrew").json()["problem"] == ""


def test_an_axis_that_is_not_there_and_a_lower_role_are_refused(
    web: httpx.Client, quiet_panel: Served
) -> None:
    answer = web.get("/api/ballscrew", params={"axis": 5})
    assert answer.json()["error"]["text"] == "axis 5 is not configured"
    quiet_panel.panel.accounts.set_password(Role.SETUP, "a password")
    web.post("/api/login", json={"role": "setup", "password": "a password"})
    body = {"axis": 0, "is_on": True, "text": TEXT}
    assert web.post("/api/ballscrew/check", json={"axis": 0, "text": TEXT}).status_code == 200
    assert web.put("/api/ballscrew", json=body).status_code == 403
