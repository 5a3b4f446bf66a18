"""Files that are kept under names where the panel runs: the rules of all kinds."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from threading import Thread
from typing import Any, get_args

import httpx
import pytest
from tests.panel.bench import Served
from tests.panel.test_kept_kinds import SAMPLES, SETUP, text
from tests.waiting import LIMIT_S

from openacr.errors import UserError
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.server import kept
from openacr.panel.server.kept import KeptFiles, root_of
from openacr.panel.server.kept_kinds import KINDS, KindWord
from openacr.panel.work.project_texts import write


@pytest.fixture(params=get_args(KindWord))
def kind(request: pytest.FixtureRequest) -> Any:
    return request.param


@pytest.fixture
def files(tmp_path: Path, kind: KindWord) -> KeptFiles:
    return KeptFiles(tmp_path, kind)


@pytest.fixture
def folder(tmp_path: Path, kind: KindWord) -> Path:
    return tmp_path / KINDS[kind].folder


@pytest.fixture
def bounds(monkeypatch: pytest.MonkeyPatch, kind: KindWord) -> None:
    """At most two of this kind, of 1500 bytes each."""
    monkeypatch.setitem(KINDS, kind, replace(KINDS[kind], most=2, most_bytes=1500))


def names(files: KeptFiles) -> list[str]:
    return [each["name"] for each in files.entries()]


def test_what_is_kept_is_listed_by_name_read_renamed_and_deleted(
    files: KeptFiles, folder: Path, kind: KindWord
) -> None:
    one, other = SAMPLES[kind]
    assert files.entries() == []
    for name, found in (("before", one), ("Z axis", other), ("After", one)):
        files.store(name, text(found), replace=False)
    assert names(files) == ["After", "before", "Z axis"]
    assert sorted(each.name for each in folder.iterdir()) == [
        f"After.{kind}.json", f"Z axis.{kind}.json", f"before.{kind}.json",
    ]  # fmt: skip
    assert json.loads(files.read("Z axis")) == other
    assert json.loads(files.read("before")) == one
    entry = files.entries()[2]
    assert entry["kind"] == kind
    assert entry["bytes"] == (folder / f"Z axis.{kind}.json").stat().st_size
    files.rename("before", "old")
    files.delete("After")
    assert names(files) == ["old", "Z axis"]
    assert json.loads(files.read("old")) == one
    acts: tuple[Callable[[], object], ...] = (
        lambda: files.read("before"),
        lambda: files.delete("before"),
        lambda: files.rename("before", "new"),
    )
    for missing in acts:
        with pytest.raises(PanelError, match=r"there is no .* before") as refused:
            missing()
        assert refused.value.code == "missing"


def test_of_two_browsers_that_take_the_same_name_the_later_one_is_refused(
    files: KeptFiles, kind: KindWord, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = SAMPLES[kind]
    refused: list[str] = []

    def store_the_other() -> None:
        try:
            files.store("a", text(other), replace=False)
        except PanelError as error:
            refused.append(error.code)

    later = Thread(target=store_the_other)

    def slow(file: Path, content: str) -> None:
        if later.ident is None:
            later.start()
            later.join(0.1)  # it has to wait for this one
        write(file, content)

    monkeypatch.setattr(kept, "write", slow)
    files.store("a", text(one), replace=False)
    later.join()
    assert refused == ["conflict"]
    assert json.loads(files.read("a")) == one


def test_a_name_that_is_taken_is_kept_unless_it_is_to_be_replaced(
    files: KeptFiles, kind: KindWord
) -> None:
    one, other = SAMPLES[kind]
    files.store("a", text(one), replace=False)
    files.store("b", text(one), replace=False)
    acts: tuple[Callable[[], object], ...] = (
        lambda: files.store("a", text(other), replace=False),
        lambda: files.rename("b", "a"),
    )
    for taking in acts:
        with pytest.raises(PanelError, match=f"the {KINDS[kind].noun} a is there") as refused:
            taking()
        assert refused.value.code == "conflict"
    assert json.loads(files.read("a")) == one
    files.store("a", text(other), replace=True)
    assert json.loads(files.read("a")) == other
    files.rename("b", "b")
    assert names(files) == ["a", "b"]


@pytest.mark.parametrize(
    "name",
    ["", "../a", ".a", "a/b", "a\\b", "a.", "a ", "a\n", "x" * 61, "ä" * 61, "字" * 41, "nul",
     "Com1.x", "con .x"],
)  # fmt: skip
def test_a_name_that_no_file_should_have_is_refused(tmp_path: Path, name: str) -> None:
    files = KeptFiles(tmp_path, "setup")
    for act in (
        lambda: files.store(name, text(SETUP), replace=False),
        lambda: files.read(name),
        lambda: files.delete(name),
        lambda: files.rename(name, "a"),
        lambda: files.rename("a", name),
    ):
        with pytest.raises(UserError, match="is no name: up to 60 letters"):
            act()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "name", ["x" * 60, "ä" * 60, "字" * 40, "7", "const", "com", "Z-axis +2.5, new_1"]
)
def test_a_name_of_60_letters_or_one_that_only_begins_as_a_device_is_taken(
    tmp_path: Path, name: str
) -> None:
    files = KeptFiles(tmp_path, "setup")
    files.store(name, text(SETUP), replace=False)
    assert names(files) == [name]


@pytest.mark.usefixtures("bounds")
def test_how_many_are_kept_is_bounded_for_each_kind(tmp_path: Path, kind: KindWord) -> None:
    files, (one, other) = KeptFiles(tmp_path, kind), SAMPLES[kind]
    for name in ("a", "b"):
        files.store(name, text(one), replace=False)
    with pytest.raises(UserError, match=r"c: 2 of the kind .* the most there can be: delete one"):
        files.store("c", text(one), replace=False)
    files.store("b", text(other), replace=True)
    for another in set(get_args(KindWord)) - {kind}:
        KeptFiles(tmp_path, another).store("c", text(SAMPLES[another][0]), replace=False)
    files.delete("a")
    files.store("c", text(one), replace=False)
    assert names(files) == ["b", "c"]


@pytest.mark.usefixtures("bounds")
def test_a_file_that_another_hand_has_changed_is_in_no_list_and_refused(
    tmp_path: Path, folder: Path, kind: KindWord
) -> None:
    files, (one, other) = KeptFiles(tmp_path, kind), SAMPLES[kind]
    for name in ("a", "b"):
        files.store(name, text(one), replace=False)
    assert names(files) == ["a", "b"]
    file = folder / f"a.{kind}.json"
    file.write_text("{}")
    (folder / f"~b.{kind}.json").write_bytes((folder / f"b.{kind}.json").read_bytes())
    (folder / "b.json").write_text("{}")
    assert names(files) == ["b"]
    with pytest.raises(UserError, match=r"a is no .*missing required field"):
        files.read("a")
    good = text(one)
    file.write_bytes(good + b" " * (1501 - len(good)))
    assert names(files) == ["b"]
    with pytest.raises(UserError, match=rf"a.{kind}.json has 1501 bytes: .* has 1500 at most"):
        files.read("a")
    file.write_bytes(good + b" " * (1500 - len(good)))
    assert names(files) == ["a", "b"]
    file.write_text("{}")
    files.store("c", text(one), replace=False)  # a damaged one takes no place
    files.delete("c")
    files.store("a", text(other), replace=True)
    assert json.loads(files.read("a")) == other


def test_files_are_kept_in_the_project_else_beside_the_store() -> None:
    project, store = Path("/machine/project"), Path("/machine/stores/sysvar.db")
    assert root_of(project, store) == root_of(project, None) == project
    assert root_of(None, store) == Path("/machine/stores")
    assert root_of(None, None) is None


def test_a_store_in_memory_lists_nothing_and_says_where_files_would_be_kept(
    kind: KindWord,
) -> None:
    files = KeptFiles(None, kind)
    assert files.entries() == []
    with pytest.raises(UserError, match=r"is kept here: the store is in memory; name a store"):
        files.store("a", text(SAMPLES[kind][0]), replace=False)


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path, kind: KindWord) -> None:
    (tmp_path / KINDS[kind].folder).write_text("a file")
    with pytest.raises(UserError, match=rf"a\.{kind}\.json: cannot be written: "):
        KeptFiles(tmp_path, kind).store("a", text(SAMPLES[kind][0]), replace=False)


@pytest.fixture
def web(kept_panel: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=f"{kept_panel.url}/api", timeout=LIMIT_S) as client:
        yield client


def test_browsers_share_them_over_http(
    web: httpx.Client, kept_panel: Served, kind: KindWord
) -> None:
    one, other = SAMPLES[kind]
    mine = {"kind": kind, "name": "shared"}
    bounds = {"most": KINDS[kind].most, "most_bytes": KINDS[kind].most_bytes}
    assert web.put("/kept/file", params=mine, content=text(one)).json() == {"name": "shared"}
    taken = web.put("/kept/file", params=mine, content=text(other))
    assert (taken.status_code, taken.json()["error"]["code"]) == (409, "conflict")
    assert web.get("/kept/file", params=mine).json() == one
    again = web.put("/kept/file", params={**mine, "replace": "true"}, content=text(other))
    assert again.is_success
    found = web.get("/kept", params={"kind": kind}).json()
    assert [each.pop("name") for each in found.pop("files")] == ["shared"]
    assert found == bounds
    assert web.get("/kept/file", params=mine).json() == other
    assert kept_panel.store is not None
    folder = kept_panel.store.parent / KINDS[kind].folder
    assert (folder / f"shared.{kind}.json").is_file()
    assert web.post("/kept/rename", json={**mine, "to": "other"}).json() == {"name": "other"}
    gone = web.get("/kept/file", params=mine)
    said = f"there is no {KINDS[kind].noun} shared"
    assert (gone.status_code, gone.json()["error"]["text"]) == (404, said)
    assert web.delete("/kept/file", params={**mine, "name": "other"}).json() == {}
    assert web.get("/kept", params={"kind": kind}).json() == {"files": [], **bounds}
    large = web.put("/kept/file", params=mine, content=b" " * (KINDS[kind].most_bytes + 1))
    assert large.status_code == 413
    assert web.get("/kept", params={"kind": "other"}).status_code == 400
