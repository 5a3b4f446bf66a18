"""Measurements of servo tuning kept under names, as files beside the store."""

import json
from pathlib import Path
from typing import Any

import httpx
import msgspec
import pytest
from tests.mill.live import LIMIT_S
from tests.panel.bench import Served

from openacr.errors import UserError
from openacr.panel.work import tunings
from openacr.panel.work.tunings import Tunings, folder_of

CURVE = {"time_s": [0.0, 0.1], "setpoint_cnt": [0.0, 100.0], "actual_cnt": [0.0, 90.5]}
RESPONSE = {"magnitude_db": [3.0, -3.0], "phase_deg": [-90.0, -150.0]}
MEASURED: dict[str, Any] = {
    "axis": "X",
    "at": "2026-11-27T14:00:00",
    "time_s": 0.55,
    "amplitude_cnt": 100.0,
    "band_hz": [2.0, 60.0],
    "present": {
        "gains": {"PGAIN": 0.002},
        "filters": None,
        "margins": {"phase_deg": 50.0, "gain_db": None, "is_stable": True},
        "figures": {"overshoot_percent": 12.0},
        "rms_error_cnt": 7.5,
        "step": CURVE,
    },
    "bode": {
        "frequency_hz": [1.0, 10.0],
        "present": RESPONSE,
        "measured": {**RESPONSE, "frequency_hz": [2.0, 60.0], "coherence": [1.0, 0.9]},
    },
    "trial": {"figures": {"overshoot_percent": 13.0, "settling_s": None}, "measured": CURVE},
}


@pytest.fixture
def folder(kept_panel: Served) -> Path:
    found = folder_of(kept_panel.store)
    assert found is not None
    for each in found.glob("*") if found.is_dir() else ():
        each.unlink()
    return found


def ask(served: Served, method: str, path: str, **more: Any) -> Any:
    return httpx.request(method, f"{served.url}/api/{path}", timeout=LIMIT_S, **more)


def kept(served: Served, name: str, tuning: dict[str, Any] = MEASURED) -> Any:
    return ask(served, "POST", "tunings", json={"name": name, "tuning": tuning})


def names(served: Served) -> list[tuple[int, str]]:
    found = ask(served, "GET", "tunings").json()["tunings"]
    return [(each["number"], each["name"]) for each in found]


def test_a_measurement_is_kept_renamed_exported_read_again_and_deleted(
    kept_panel: Served, folder: Path
) -> None:
    assert names(kept_panel) == []
    assert kept(kept_panel, "before").json() == {"number": 1}
    assert kept(kept_panel, "stiffer").json() == {"number": 2}
    (entry,) = [
        each for each in ask(kept_panel, "GET", "tunings").json()["tunings"] if each["number"] == 2
    ]
    size = (folder / "2.json").stat().st_size
    assert entry == {
        "number": 2, "name": "stiffer", "axis": "X", "at": MEASURED["at"], "bytes": size,
    }  # fmt: skip
    assert ask(kept_panel, "POST", "tunings/rename", json={"number": 1, "name": "old"}).json() == {}
    assert names(kept_panel) == [(1, "old"), (2, "stiffer")]
    file = ask(kept_panel, "GET", "tunings/file", params={"number": 1}).json()
    assert file["name"] == "old"
    filled = {**RESPONSE, "frequency_hz": [], "coherence": []}
    bode = {**MEASURED["bode"], "present": filled}
    assert file["tuning"] == {**MEASURED, "bode": bode}
    assert ask(kept_panel, "DELETE", "tunings", params={"number": 1}).json() == {}
    assert names(kept_panel) == [(2, "stiffer")]
    assert ask(kept_panel, "POST", "tunings", json=file).json() == {"number": 3}
    again = ask(kept_panel, "GET", "tunings/file", params={"number": 3}).json()
    assert again == file
    assert sorted(each.name for each in folder.iterdir()) == ["2.json", "3.json"]


@pytest.mark.parametrize(
    ("name", "change", "status", "said"),
    [
        ("", {}, 400, "name"),
        ("  ", {}, 400, "name"),
        ("two\nlines", {}, 400, "name"),
        ("n" * 61, {}, 400, "60"),
        ("taken", {}, 422, "taken: there is a measurement of this name: choose another one"),
        ("a", {"present": {}}, 400, "gains"),
        ("a", {"trial": {"figures": {}, "measured": {**CURVE, "actual_cnt": [1.0]}}}, 422,
         "this is no measurement: a curve has not as many values as times"),
        ("a", {"bode": {**MEASURED["bode"], "frequency_hz": [1.0]}}, 422, "no measurement"),
        ("a", {"bode": {**MEASURED["bode"], "measured": RESPONSE}}, 422, "no measurement"),
        ("a", {"axis": "X" * 41}, 400, "40"),
    ],
)  # fmt: skip
def test_what_is_no_measurement_or_has_no_free_name_is_refused_and_not_kept(
    kept_panel: Served, folder: Path, name: str, change: dict[str, Any], status: int, said: str
) -> None:
    kept(kept_panel, "taken")
    answer = kept(kept_panel, name, {**MEASURED, **change})
    assert answer.status_code == status, answer.text
    assert said in answer.json()["error"]["text"]
    assert [each.name for each in folder.iterdir()] == ["1.json"]


def test_a_name_that_another_has_is_refused_and_its_own_is_not(
    kept_panel: Served, folder: Path
) -> None:
    for name in ("one", "two"):
        kept(kept_panel, name)
    rename = {"number": 1, "name": "two"}
    answer = ask(kept_panel, "POST", "tunings/rename", json=rename)
    assert answer.status_code == 422
    assert names(kept_panel) == [(1, "one"), (2, "two")]
    assert ask(kept_panel, "POST", "tunings/rename", json={**rename, "name": "one"}).is_success
    gone = ask(kept_panel, "DELETE", "tunings", params={"number": 7})
    assert gone.json()["error"]["text"] == "measurement 7 is not kept any more"
    assert len(list(folder.iterdir())) == 2


def test_number_and_size_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tunings, "MOST", 2)
    monkeypatch.setattr(tunings, "MOST_BYTES", 3000)
    here = Tunings(tmp_path / "kept")
    made = msgspec.convert(MEASURED, tunings.Tuning)
    assert [here.keep("a", made), here.keep("b", made)] == [1, 2]
    with pytest.raises(UserError, match="2 measurements are kept, the most there can be"):
        here.keep("c", made)
    here.delete(1)
    long = {**CURVE, "time_s": [0.125] * 1000, "setpoint_cnt": [0.0] * 1000}
    large = {**MEASURED, "trial": {"figures": {}, "measured": {**long, "actual_cnt": [0.0] * 1000}}}
    with pytest.raises(UserError, match=r"c: \d+ bytes: a measurement has 3000 at most"):
        here.keep("c", msgspec.convert(large, tunings.Tuning))
    assert [each["number"] for each in here.entries()] == [2]


def test_a_store_in_memory_keeps_none_and_a_file_that_is_none_is_left_out(tmp_path: Path) -> None:
    made = msgspec.convert(MEASURED, tunings.Tuning)
    with pytest.raises(UserError, match="a store in memory keeps no measurements"):
        Tunings(folder_of(None)).keep("a", made)
    here = Tunings(tmp_path)
    (tmp_path / "1.json").write_text("{}")
    (tmp_path / "notes.json").write_text(json.dumps({"name": "x", "tuning": MEASURED}))
    assert here.entries() == []
    assert here.keep("a", made) == 2
    with pytest.raises(UserError, match="measurement 1 is not kept any more"):
        here.read(1)
