"""Journals of served cards over HTTP: listed and read by the service, nothing else is."""

import os
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from tests.panel.bench import Served

from openacr.controller.ring import SUFFIX
from openacr.panel.roles import Role

OLD, NEW = f"mill/1{SUFFIX}", f"lathe/12{SUFFIX}"


@pytest.fixture
def quiet_panel(kept_quiet_panel: Served) -> Served:
    return kept_quiet_panel


@pytest.fixture
def web(quiet_panel: Served, tmp_path: Path) -> Iterator[httpx.Client]:
    """A panel beside two journals of served cards, and other files."""
    root = tmp_path / "journals"
    quiet_panel.panel.journals = root
    for name, text, changed_s in (
        (OLD, b"old", 1_000_000_000), (NEW, b"newer", 1_100_000_000), ("mill/notes.txt", b"", 0),
        (f"../secret/1{SUFFIX}", b"secret", 0), (f"1{SUFFIX}", b"loose", 0),
    ):  # fmt: skip
        place = root / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text)
        os.utime(place, (changed_s, changed_s))
    (root / "linked").symlink_to(tmp_path / "secret")
    (root / "mill" / f"2{SUFFIX}").symlink_to(tmp_path / "secret" / f"1{SUFFIX}")
    with httpx.Client(base_url=quiet_panel.url) as client:
        yield client


def test_journals_are_listed_the_latest_first(web: httpx.Client) -> None:
    found = web.get("/api/journals").json()["journals"]
    assert [(each["path"], each["bytes"]) for each in found] == [(NEW, 5), (OLD, 3)]
    assert found[0]["changed"].startswith("2004-11-")


def test_a_journal_is_read_as_a_file(web: httpx.Client) -> None:
    answer = web.get("/api/journals/file", params={"path": NEW})
    assert (answer.status_code, answer.content) == (200, b"newer")
    name = NEW.replace("/", "-")
    assert answer.headers["content-disposition"] == f'attachment; filename="{name}"'


@pytest.mark.parametrize(
    "path",
    [
        f"../secret/1{SUFFIX}", f"mill/../../secret/1{SUFFIX}", f"linked/1{SUFFIX}",
        f"mill/2{SUFFIX}", "mill/notes.txt", f"1{SUFFIX}", f"/mill/1{SUFFIX}", "", "mill",
        f"mill\\1{SUFFIX}",
    ],
)  # fmt: skip
def test_a_path_that_is_not_in_the_list_is_refused(web: httpx.Client, path: str) -> None:
    answer = web.get("/api/journals/file", params={"path": path})
    assert answer.status_code == 404
    assert answer.json()["error"]["text"] == f"{path}: there is no such journal"


def test_without_the_folder_there_are_no_journals(web: httpx.Client, quiet_panel: Served) -> None:
    for folder in (None, Path("/nowhere/at/all")):
        quiet_panel.panel.journals = folder
        assert web.get("/api/journals").json() == {"journals": []}
        assert web.get("/api/journals/file", params={"path": OLD}).status_code == 404


def test_journals_need_the_role_service(web: httpx.Client, quiet_panel: Served) -> None:
    accounts = quiet_panel.panel.accounts
    for role, status in ((Role.SETUP, 403), (Role.SERVICE, 200)):
        accounts.set_password(role, "a password")
        log_in = {"role": role.word, "password": "a password"}
        assert web.post("/api/login", json=log_in).status_code == 200
        assert web.get("/api/journals").status_code == status
        assert web.get("/api/journals/file", params={"path": OLD}).status_code == status
