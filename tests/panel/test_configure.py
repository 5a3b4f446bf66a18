"""The configuration wizard over HTTP: dialogs, code of answers, answers of code."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from msgspec import inspect
from tests.panel.bench import LIMIT_S, Served

from openacr.configure import code_files, parse_answers
from openacr.configure.dialogs import DIALOGS

GANTRY = Path(__file__).parents[2] / "examples" / "gantry"


@pytest.fixture
def quiet_panel(kept_quiet_panel: Served) -> Served:
    return kept_quiet_panel


@pytest.fixture
def web(quiet_panel: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=f"{quiet_panel.url}/api", timeout=LIMIT_S) as client:
        yield client


def code(web: httpx.Client, answers: dict[str, Any]) -> dict[str, Any]:
    answer = web.post("/configure/code", json={"answers": answers})
    assert answer.status_code == 200
    found: dict[str, Any] = answer.json()
    return found


def test_every_answer_is_in_one_dialog_with_its_limits() -> None:
    for dialog in DIALOGS:
        info = inspect.type_info(dialog.table)
        assert isinstance(info, inspect.StructType)
        keys = [
            field.encode_name
            for field in info.fields
            if not isinstance(field.type, inspect.StructType)
        ]
        assert [row.key for row in dialog.rows] == keys
        within = [each.within for each in DIALOGS if each.of == dialog.of and each.within]
        tables = [f.encode_name for f in info.fields if isinstance(f.type, inspect.StructType)]
        assert dialog.within or tables == within


def test_dialogs_come_with_kinds_limits_and_defaults(web: httpx.Client) -> None:
    found = {each["name"]: each for each in web.get("/configure").json()["dialogs"]}
    rows = {row["key"]: row for each in found.values() for row in each["rows"]}
    assert rows["model"]["choices"][0] == "ACR1200"
    assert (rows["bit_rate_kbps"]["low"], rows["bit_rate_kbps"]["high"]) == (10, 1000)
    assert (rows["dgain"]["kind"], rows["dgain"]["default"]) == ("number", 0.00001)
    assert (rows["first_input"]["kind"], rows["first_input"]["is_optional"]) == ("count", True)
    assert [rows[key]["kind"] for key in ("soft", "soft_is_enabled", "axes")] == [
        "pair", "switch", "names",
    ]  # fmt: skip
    assert rows["units_per_rev"]["default"] is None
    assert (found["limits"]["of"], found["limits"]["within"]) == ("axis", "limits")


def test_the_first_answers_make_code(web: httpx.Client) -> None:
    first = web.get("/configure").json()["answers"]
    found = code(web, first)
    assert (found["errors"], found["warnings"]) == ([], [])
    assert list(found["files"]) == ["configure.toml", "setup.8k", "prog15.8k"]
    text = found["files"]["configure.toml"]
    plain = code_files(parse_answers(text), text)
    assert found["files"]["prog15.8k"] == plain["prog15.8k"]
    lines = found["files"]["setup.8k"].splitlines()
    assert [line.split(" : REM ")[0] for line in lines] == plain["setup.8k"].splitlines()
    assert "AXIS0 ON : REM" in found["files"]["setup.8k"]


def test_what_is_wrong_is_said_with_its_place(web: httpx.Client) -> None:
    axis = {"number": 0, "name": "X", "units_per_rev": 5, "counts_per_rev": 8000}
    wrong = {"axis": [axis, {**axis, "name": "Y", "units_per_rev": -1}]}
    assert code(web, wrong) == {
        "errors": [
            {"where": ["axis", 1, "units_per_rev"], "text": "units_per_rev: expected `float` > 0.0"}
        ]
    }
    twice = code(web, {"axis": [axis, axis]})
    assert [each["where"] for each in twice["errors"]] == [
        ["axis", 1, "number"], ["axis", 1, "name"],
    ]  # fmt: skip
    assert code(web, {"axis": [{**axis, "colour": 1}]})["errors"] == [
        {"where": ["axis", 0, "colour"], "text": "unknown key 'colour'"}
    ]
    alone = code(web, {"axis": [axis]})
    assert alone["warnings"] == ["axis X has no master: it can jog, but takes part in no move"]


def read(web: httpx.Client, name: str, text: str, **more: str) -> httpx.Response:
    return web.post("/configure/read", json={"name": name, "text": text, **more})


def test_code_becomes_the_answers_that_make_it(web: httpx.Client) -> None:
    text = (GANTRY / "setup.8k").read_text() + "\nSYS\nAXIS0 JOG VEL 7\n"
    found = read(web, "setup.8k", text).json()
    assert found["notes"] == ["AXIS0 JOG VEL is 7; these answers make it 0"]
    assert [axis["name"] for axis in found["answers"]["axis"]] == ["X", "Y", "Z"]
    again = code(web, found["answers"])["files"]["setup.8k"]
    assert "AXIS2 SLM (6,0)" in again and "AXIS0 HLDEC 500" in again


def test_a_file_of_answers_is_read_as_it_is(web: httpx.Client) -> None:
    text = (GANTRY / "configure.toml").read_text()
    found = read(web, "Configure.TOML", text).json()
    assert found["notes"] == []
    assert found["answers"]["axis"][0]["units_per_rev"] == 0.2
    wrong = read(web, "mine.toml", text.replace("8000", "0", 1))
    assert wrong.status_code == 422
    assert wrong.json()["error"]["text"].startswith("mine.toml:11:1: counts_per_rev: expected")


def test_code_that_the_card_refuses_is_named_with_its_line(web: httpx.Client) -> None:
    refused = read(web, "old.8k", "SYS\nFLOP 3\n")
    assert refused.status_code == 422
    assert refused.json()["error"]["text"].startswith("old.8k:2: Unknown command")
    empty = read(web, "a.8k", "SYS\n").json()["error"]["text"]
    assert empty == "no program has a master with axes: there is nothing to recover"
    assert read(web, "a.8k", "", model="ACR1").status_code == 400


def test_code_is_tried_on_the_card_it_is_for(web: httpx.Client) -> None:
    text = (GANTRY / "setup.8k").read_text()
    found = read(web, "setup.8k", text, model="ACR1200").json()
    assert found["answers"]["card"]["model"] == "ACR1200"
