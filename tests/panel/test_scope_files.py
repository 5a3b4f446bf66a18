"""Set-ups and references of the scope that are kept under names where the panel runs."""

import json
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.panel.bench import Served

from openacr.errors import UserError
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.server.kept_scopes import MOST, ScopeFiles

CHANNEL = {
    "source": "P12290", "color": "#1f77b4", "scale": "1", "offset": "0", "unit": "",
    "format": "plain",
}  # fmt: skip
SETUP = {"channels": [CHANNEL], "settings": {"mode": "single", "level": "0.5"}}
TRACE = {
    "label": "CH1", "id": "P12290", "name": "", "unit": "mm", "format": "plain", "color": "#1f77b4",
    "isFlag": False, "scale": 1.0, "offset": 0.0, "values": [1.5, None, -2.0],
}  # fmt: skip
REFERENCE = {"traces": [TRACE], "period": 0.001, "start": -10.0, "from": -10.0}


def text(found: object) -> bytes:
    return json.dumps(found).encode()


@pytest.fixture
def files(tmp_path: Path) -> ScopeFiles:
    return ScopeFiles(tmp_path)


def names(files: ScopeFiles) -> list[tuple[str, str]]:
    return [(each["kind"], each["name"]) for each in files.entries()]


def test_what_is_kept_is_listed_read_renamed_and_deleted(files: ScopeFiles, tmp_path: Path) -> None:
    assert files.entries() == []
    files.store("setup", "Z axis", text(SETUP), replace=False)
    files.store("reference", "before", text(REFERENCE), replace=False)
    files.store("reference", "After", text(REFERENCE), replace=False)
    assert names(files) == [("reference", "After"), ("reference", "before"), ("setup", "Z axis")]
    assert sorted(each.name for each in (tmp_path / "scope").iterdir()) == [
        "After.reference.json", "Z axis.setup.json", "before.reference.json",
    ]  # fmt: skip
    assert json.loads(files.read("setup", "Z axis")) == SETUP
    assert json.loads(files.read("reference", "before")) == REFERENCE
    entry = files.entries()[2]
    assert entry["bytes"] == (tmp_path / "scope" / "Z axis.setup.json").stat().st_size
    files.rename("reference", "before", "old")
    files.delete("reference", "After")
    assert names(files) == [("reference", "old"), ("setup", "Z axis")]


def test_a_name_that_is_taken_is_kept_unless_it_is_to_be_replaced(files: ScopeFiles) -> None:
    other = {**SETUP, "settings": {}}
    files.store("setup", "a", text(SETUP), replace=False)
    files.store("setup", "b", text(SETUP), replace=False)
    with pytest.raises(PanelError, match="the set-up a is there already") as refused:
        files.store("setup", "a", text(other), replace=False)
    assert refused.value.code == "conflict"
    with pytest.raises(PanelError, match="the set-up a is there already"):
        files.rename("setup", "b", "a")
    assert json.loads(files.read("setup", "a")) == SETUP
    files.store("setup", "a", text(other), replace=True)
    assert json.loads(files.read("setup", "a")) == other
    files.rename("setup", "b", "b")


@pytest.mark.parametrize("name", ["", "../a", ".a", "a/b", "a\\b", "a.", "a\n", "x" * 61, "ä" * 61])
def test_a_name_that_no_file_should_have_is_refused(files: ScopeFiles, name: str) -> None:
    why = "is no name: up to 60 letters"
    with pytest.raises(UserError, match=why):
        files.store("setup", name, text(SETUP), replace=False)
    with pytest.raises(UserError, match=why):
        files.read("setup", name)
    with pytest.raises(UserError, match=why):
        files.delete("setup", name)


@pytest.mark.parametrize(
    ("kind", "found", "why"),
    [
        ("setup", b"nonsense", "JSON is malformed"),
        ("setup", b"\xff\xfe", "is no set-up of the scope"),
        ("setup", text(REFERENCE), "unknown field `traces`"),
        ("setup", text({**SETUP, "channels": [CHANNEL] * 10}), "length <= 9"),
        ("setup", text({"channels": [{**CHANNEL, "color": "red"}], "settings": {}}), "color"),
        ("reference", text({**REFERENCE, "period": 0}), "period"),
        ("reference", text({**REFERENCE, "traces": [{**TRACE, "values": ["1"]}]}), "values"),
        ("reference", b"[" * 100_000, "is no reference of the scope"),
    ],
)
def test_what_is_no_setup_or_reference_is_refused_with_what_is_wrong(
    files: ScopeFiles, kind: Any, found: bytes, why: str
) -> None:
    with pytest.raises(UserError, match=r"^mine is no ") as refused:
        files.store(kind, "mine", found, replace=False)
    assert why in str(refused.value)
    assert files.entries() == []


def test_no_more_than_64_of_a_kind_are_kept(files: ScopeFiles) -> None:
    for n in range(MOST):
        files.store("setup", f"{n}", text(SETUP), replace=False)
    with pytest.raises(UserError, match="there are 64 of the kind set-up: delete one first"):
        files.store("setup", "one more", text(SETUP), replace=False)
    files.store("setup", "5", text(SETUP), replace=True)
    files.store("reference", "one more", text(REFERENCE), replace=False)
    assert len(files.entries()) == MOST + 1


def test_a_file_that_another_hand_has_changed_is_refused(files: ScopeFiles, tmp_path: Path) -> None:
    files.store("setup", "a", text(SETUP), replace=False)
    file = tmp_path / "scope" / "a.setup.json"
    file.write_text("{}")
    with pytest.raises(UserError, match=r"a is no set-up of the scope: .*`channels`"):
        files.read("setup", "a")
    file.write_bytes(b" " * ((4 << 20) + 1))
    with pytest.raises(UserError, match="a has more than 4194304 bytes"):
        files.read("setup", "a")


def test_browsers_share_them_over_http(quiet_panel: Served) -> None:
    with httpx.Client(base_url=f"{quiet_panel.url}/api/scope", timeout=60.0) as web:
        mine = {"kind": "setup", "name": "shared"}
        assert web.put("/file", params=mine, content=text(SETUP)).json() == {"name": "shared"}
        taken = web.put("/file", params=mine, content=text(SETUP))
        assert (taken.status_code, taken.json()["error"]["code"]) == (409, "conflict")
        assert web.put("/file", params={**mine, "replace": "true"}, content=text(SETUP)).is_success
        assert [each["name"] for each in web.get("/files").json()["files"]] == ["shared"]
        assert web.get("/file", params=mine).json() == SETUP
        assert web.post("/rename", json={**mine, "to": "other"}).is_success
        gone = web.get("/file", params=mine)
        assert (gone.status_code, gone.json()["error"]["text"]) == (
            404,
            "there is no set-up shared",
        )
        assert web.delete("/file", params={**mine, "name": "other"}).json() == {}
        assert web.get("/files").json() == {"files": []}
        large = web.put("/file", params=mine, content=b" " * ((4 << 20) + 1))
        assert large.status_code == 413
