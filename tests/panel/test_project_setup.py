"""The set-up of a card beside that of its project: what differs, where, stored in its file."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.panel.bench import Served
from tests.waiting import LIMIT_S

from openacr.client import Card
from openacr.client.errors import ChangedError
from openacr.controller import Controller
from openacr.panel.control.operator.card_jogs import CardJogs
from openacr.panel.machine.project import of_project
from openacr.panel.server.calls import project
from openacr.panel.work.project_setup import (
    Reading,
    SetupRow,
    compared,
    not_compared,
    places,
    store,
    version,
)
from openacr.project import find_project

EXAMPLES = Path(__file__).parents[2] / "examples"
OWN = "PROG7"


@pytest.fixture
def gantry(tmp_path: Path) -> Path:
    return shutil.copytree(EXAMPLES / "gantry", tmp_path / "gantry")


def reading(gantry: Path, *lines: str, machine: tuple[str, ...] = ()) -> Reading:
    """What a card of the project reports after some more lines."""
    controller, refused = Controller.load(find_project(gantry))
    assert not refused
    controller.send("HALT ALL\r")
    with Card.open(controller) as card:
        for line in lines:
            card.command(line)
        return Reading(card.read_all(), OWN, "PROG0", machine)


def line_of(gantry: Path, text: str) -> int:
    return (gantry / "setup.8k").read_text().splitlines().index(text) + 1


def test_each_setting_that_differs_has_its_line_its_name_and_both_values(gantry: Path) -> None:
    found = reading(
        gantry, "AXIS0 PGAIN 0.003", "SYS", "DIM PLC1(500)", "#DEFINE speed P20",
        "PROG1", "ACC 30", "P20=7", "SYS", "SET BIT16150",
    )  # fmt: skip
    rows = {each.key: each for each in compared(gantry, found)}
    assert {key: (each.project, each.card) for key, each in rows.items()} == {
        "AXIS0 PGAIN": ("0.002441", "0.003"),
        "DIM PLC1": (None, "500"),
        "#DEFINE speed": (None, "P20"),
        "PROG1 ACC": ("20", "30"),
        "BIT16150": ("CLR", "SET"),
        "AXIS0 SLIM": ("0", "1"),
    }
    assert rows["AXIS0 PGAIN"].line == line_of(gantry, "AXIS0 PGAIN 0.002441")
    assert rows["PROG1 ACC"].line == line_of(gantry, "ACC 20")
    assert rows["DIM PLC1"].line == 0
    assert "axis X" in rows["AXIS0 PGAIN"].name
    assert compared(gantry, reading(gantry)) == []
    assert "network address" in not_compared(found)[-1]


def test_what_acromill_sets_is_its_own_and_another_value_is_not(gantry: Path) -> None:
    lines = ("AXIS0 JOG ACC 150", "AXIS0 IPB 5", "ENC0 MULT 1", "AXIS1 PGAIN 1")
    typed = ("AXIS0 JOG ACC 150", "AXIS0 IPB 5", "ENC0 MULT 1", "AXIS1 PGAIN 2")
    more = ("PROG7", "DIM LV(3)", "PROG0", 'ATTACH SLAVE2 AXIS3 "A"', "SYS")
    found = compared(gantry, reading(gantry, *typed, *more, machine=lines))
    assert [each.key for each in found if not each.by] == ["AXIS1 PGAIN"]
    theirs = {each.key for each in found if each.by == "machine"}
    assert theirs >= {"AXIS0 JOG ACC", "AXIS0 IPB", "ENC0 MULT", "PROG0 ATTACH SLAVE2"}
    assert not any(key.startswith(OWN) for key in theirs)
    plain = compared(gantry, reading(gantry, *typed))
    assert "AXIS0 JOG ACC" in [each.key for each in plain if not each.by]


def test_what_differs_is_stored_where_its_line_is_and_the_rest_of_the_file_stays(
    gantry: Path,
) -> None:
    file = gantry / "setup.8k"
    before = file.read_text().splitlines()
    found = reading(
        gantry, "AXIS0 PGAIN 0.003", "PROG1", "ACC 30", "LOOK ON", "SYS", "DIM PLC1(500)"
    )
    known = version(gantry)
    stored = store(gantry, found, known)
    assert {each.key for each in stored} >= {"AXIS0 PGAIN", "PROG1 ACC", "DIM PLC1"}
    after = file.read_text().splitlines()
    changed = {(a, b) for a, b in zip(before, after, strict=False) if a != b}
    assert changed == {("AXIS0 PGAIN 0.002441", "AXIS0 PGAIN 0.003"), ("ACC 20", "ACC 30")}
    added = after[len(before) :]
    assert added[added.index("DIM PLC1(500)") - 1] == "SYS"
    assert added[added.index("LOOK ON") - 1] == "PROG1"
    assert compared(gantry, found) == []
    with pytest.raises(ChangedError, match=r"setup\.8k of the project was changed"):
        store(gantry, found, known)


def test_a_line_of_what_the_card_does_not_have_becomes_a_remark(gantry: Path) -> None:
    file = gantry / "setup.8k"
    file.write_text(file.read_text().replace("DIM DEF(20)", "DIM DEF(20)\n#DEFINE far P9"))
    line = line_of(gantry, "#DEFINE far P9")
    shutil.copytree(gantry, gantry.parent / "without")
    other = gantry.parent / "without" / "setup.8k"
    other.write_text(other.read_text().replace("#DEFINE far P9\n", ""))
    found = reading(gantry.parent / "without")
    assert compared(gantry, found) == [SetupRow("#DEFINE far", "", line, "P9", None, "")]
    store(gantry, found, version(gantry))
    assert file.read_text().splitlines()[line - 1] == "REM #DEFINE far P9"


def test_the_last_line_that_sets_a_value_counts_at_each_level() -> None:
    text = "SYS\nAXIS0 PGAIN 1\nPROG0\nACC 1\nPROG1\nACC 2\nAXIS0 PGAIN 2\nREM ACC 9\n"
    assert places(text) == {"AXIS0 PGAIN": 7, "PROG0 ACC": 4, "PROG1 ACC": 6}


# --- through the panel ----------------------------------------------------------------


@pytest.fixture
def served(gantry: Path, tmp_path: Path) -> Iterator[Served]:
    parts = tmp_path / "parts"
    panel = Served(
        tmp_path, installation=of_project(gantry, store=None, programs=None, otherwise=parts)
    )
    yield panel
    panel.close()


def asked(served: Served, method: str = "GET", **more: Any) -> Any:
    return httpx.request(method, f"{served.url}/api/project/setup", timeout=LIMIT_S, **more)


def test_the_panel_compares_and_stores_the_set_up_of_its_project(
    served: Served, gantry: Path
) -> None:
    first = asked(served).json()
    assert first["differs"] == 0
    assert {row[5] for row in first["rows"]} == {"machine"}
    served.call(lambda station: station.link.machine.card.command("AXIS2 DGAIN 3e-5"))
    found = asked(served).json()
    assert found["differs"] == 1
    (row,) = [each for each in found["rows"] if not each[5]]
    assert row[0] == "AXIS2 DGAIN"
    assert row[3:5] == ["1E-05", "3E-05"]
    answer = asked(served, "POST", json={"version": found["version"]})
    assert answer.json() == {"lines": 1}
    assert "AXIS2 DGAIN 3E-05" in (gantry / "setup.8k").read_text()
    assert asked(served).json()["differs"] == 0
    again = asked(served, "POST", json={"version": found["version"]})
    assert (again.status_code, again.json()["error"]["code"]) == (409, "conflict")


def test_the_set_up_is_read_once_no_axis_is_jogged(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While one is, the card has the speed of that jog; a jog without end is a sentence."""
    jogs = [True, True, False]
    monkeypatch.setattr(CardJogs, "are_active", property(lambda _: jogs.pop(0) if jogs else False))
    assert asked(served).json()["differs"] == 0
    assert jogs == []
    monkeypatch.setattr(CardJogs, "are_active", property(lambda _: True))
    monkeypatch.setattr(project, "MOST_WAIT_S", 0.3)
    for method, more in (("GET", {}), ("POST", {"json": {"version": "1"}})):
        answer = asked(served, method, **more)
        assert "READ when it rests" in answer.text
