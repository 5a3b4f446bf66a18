"""LINK over HTTP: a program from a serial line becomes a file of the folder, or leaves nothing."""

import os
import time
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest
from tests.mill.sender import Sender
from tests.panel.bench import Served

from openacr.mill.run.receiving import Patience
from openacr.panel.control.machine.installation import Installation
from openacr.panel.roles import Role
from openacr.panel.server import receptions
from openacr.panel.server.receptions import Receptions
from openacr.sysvar.tabs import COMMUNICATIONS

PROGRAM = b"%\r\nG21 G90\r\nG0 X1\r\nM2\r\n"
KEPT = b"%\nG21 G90\nG0 X1\nM2\n%\n"
LONGEST_S = 60.0


@pytest.fixture
def sender() -> Iterator[Sender]:
    one = Sender(is_read=True)
    yield one
    one.close()


@pytest.fixture
def web(kept_quiet_panel: Served, sender: Sender) -> Iterator[httpx.Client]:
    """Calls of the panel of this file, which has received nothing yet."""
    panel = kept_quiet_panel.panel
    panel.receptions = Receptions()
    with httpx.Client(base_url=kept_quiet_panel.url, timeout=LONGEST_S) as client:
        yield client
    panel.accounts._hashes = {}
    with httpx.Client(base_url=kept_quiet_panel.url, timeout=LONGEST_S) as client:
        client.delete("/api/link")  # of what is under way: it ends with its port


def until(web: httpx.Client, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """What the reception is, once something holds of it."""
    end_s = time.monotonic() + LONGEST_S
    while True:
        found: dict[str, Any] = web.get("/api/link").json()
        if holds(found):
            return found
        assert time.monotonic() < end_s, found
        time.sleep(0.01)


def ended(found: dict[str, Any]) -> bool:
    return bool(found["state"] != "receiving")


def begin(web: httpx.Client, sender: Sender, path: str, **more: object) -> httpx.Response:
    return web.post("/api/link", json={"path": path, "port": sender.port, **more})


def error_of(answer: httpx.Response) -> tuple[int, str]:
    return answer.status_code, answer.json()["error"]["text"]


def names(served: Served) -> list[str]:
    return sorted(each.name for each in served.programs.iterdir())


@pytest.mark.req("MILL-LOAD-LINK")
def test_a_received_program_is_a_file_that_is_loaded_like_any_other(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    nothing = {"state": "", "path": "", "port": "", "bytes": 0, "lines": 0, "text": ""}
    assert web.get("/api/link").json() == nothing
    started = begin(web, sender, "jobs/NEW.TXT").json()
    about = {"path": "jobs/NEW.TXT", "port": sender.port, "text": ""}
    assert started == {"state": "receiving", "bytes": 0, "lines": 0, **about}
    sender.send(PROGRAM)
    amid = until(web, lambda found: found["lines"] == 4)
    assert amid == {"state": "receiving", "bytes": 23, "lines": 4, **about}
    assert not (kept_quiet_panel.programs / "jobs").exists()
    sender.send(b"%")
    assert until(web, ended) == {"state": "kept", "bytes": 24, "lines": 4, **about}
    assert (kept_quiet_panel.programs / "jobs" / "NEW.TXT").read_bytes() == KEPT
    listed = web.get("/api/programs", params={"folder": "jobs"}).json()["entries"]
    assert [(each["path"], each["bytes"]) for each in listed] == [("jobs/NEW.TXT", len(KEPT))]


def test_the_port_is_that_of_the_communications_page(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    missing = web.post("/api/link", json={"path": "A.TXT"})
    assert error_of(missing) == (
        422, "no serial port is configured: set P750000, or name a port",
    )  # fmt: skip
    kept_quiet_panel.panel.installation.store.write_text(COMMUNICATIONS.port, sender.port)
    assert web.post("/api/link", json={"path": "A.TXT"}).json()["port"] == sender.port


def test_a_cancelled_reception_keeps_nothing_and_frees_the_port(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    before = names(kept_quiet_panel)
    assert error_of(web.delete("/api/link")) == (422, "nothing is being received")
    begin(web, sender, "A.TXT")
    sender.send(PROGRAM)
    until(web, lambda found: found["lines"] == 4)
    assert web.delete("/api/link").json()["state"] == "cancelled"
    assert error_of(web.delete("/api/link")) == (422, "nothing is being received")
    assert names(kept_quiet_panel) == before
    assert begin(web, sender, "A.TXT").json()["state"] == "receiving"


def test_an_existing_file_is_replaced_only_when_that_is_confirmed(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    file = kept_quiet_panel.programs / "A.TXT"
    file.write_bytes(b"OLD\n")
    refused = begin(web, sender, "A.TXT")
    assert error_of(refused) == (409, "A.TXT is there already")
    assert refused.json()["error"]["exists"] is True
    begin(web, sender, "A.TXT", replace=True)
    sender.send(PROGRAM)
    until(web, lambda found: found["lines"] == 4)
    assert file.read_bytes() == b"OLD\n"
    sender.send(b"%")
    assert until(web, ended)["state"] == "kept"
    assert file.read_bytes() == KEPT


def test_a_file_that_came_meanwhile_is_kept(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    begin(web, sender, "A.TXT")
    (kept_quiet_panel.programs / "A.TXT").write_bytes(b"OTHER\n")
    sender.send(PROGRAM + b"%")
    found = until(web, ended)
    assert (found["state"], found["text"]) == (
        "failed", "A.TXT is there already: nothing was kept",
    )  # fmt: skip
    assert (kept_quiet_panel.programs / "A.TXT").read_bytes() == b"OTHER\n"


def test_a_line_that_fails_in_the_middle_leaves_nothing(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    before = names(kept_quiet_panel)
    begin(web, sender, "A.TXT")
    sender.send(PROGRAM)
    until(web, lambda found: found["lines"] == 4)
    sender.hang_up()
    found = until(web, ended)
    assert found["state"] == "failed"
    assert found["text"].startswith(f"{sender.port} failed: ")
    assert found["text"].endswith(": nothing was kept")
    assert names(kept_quiet_panel) == before


def test_a_sender_that_stops_in_the_middle_leaves_nothing(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(receptions, "PATIENCE", Patience(amid_s=0.2))
    before = names(kept_quiet_panel)
    begin(web, sender, "A.TXT")
    sender.send(PROGRAM)
    found = until(web, ended)
    why = "the sender stopped after line 4, before the closing % (silent for 0.2 s)"
    assert (found["state"], found["text"]) == (
        "failed", f"{sender.port}: {why}: nothing was kept",
    )  # fmt: skip
    assert names(kept_quiet_panel) == before


@pytest.mark.parametrize(
    ("path", "status", "text"),
    [
        ("../A.TXT", 422, "../A.TXT: this name is not allowed"),
        ("/", 400, "/: it is a folder"),
        ("plate.nc", 409, "plate.nc is there already"),
    ],
)
def test_names_that_cannot_be_stored_are_refused_at_once(
    web: httpx.Client, sender: Sender, path: str, status: int, text: str
) -> None:
    assert error_of(begin(web, sender, path)) == (status, text)
    assert web.get("/api/link").json()["state"] == ""


def test_one_program_is_received_at_a_time(web: httpx.Client, sender: Sender) -> None:
    begin(web, sender, "A.TXT")
    again = begin(web, sender, "B.TXT")
    assert error_of(again) == (422, "a program is being received: cancel it first")
    assert web.get("/api/link").json()["path"] == "A.TXT"


def test_a_port_that_cannot_be_opened_leaves_the_last_reception_as_it_was(
    web: httpx.Client, sender: Sender
) -> None:
    begin(web, sender, "A.TXT")
    web.delete("/api/link")
    refused = web.post("/api/link", json={"path": "B.TXT", "port": "/dev/no-such-port"})
    assert error_of(refused) == (
        422, "cannot open serial port /dev/no-such-port: No such file or directory",
    )  # fmt: skip
    found = web.get("/api/link").json()
    assert (found["state"], found["path"]) == ("cancelled", "A.TXT")


def test_the_line_of_the_card_is_not_read(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    panel = kept_quiet_panel.panel
    own = panel.installation
    panel.installation = Installation.at(sender.port, own.store, own.programs)
    answer = begin(web, sender, "A.TXT")
    panel.installation = own
    assert error_of(answer) == (422, f"{sender.port} is the port of the card: choose another one")


def test_receiving_needs_the_role_operate(
    web: httpx.Client, sender: Sender, kept_quiet_panel: Served
) -> None:
    accounts = kept_quiet_panel.panel.accounts
    for role in (Role.VIEW, Role.OPERATE):
        accounts.set_password(role, "a password")
        log_in = {"role": role.word, "password": "a password"}
        assert web.post("/api/login", json=log_in).status_code == 200
        assert web.get("/api/link").status_code == 200
        status = 200 if role is Role.OPERATE else 403
        assert begin(web, sender, "A.TXT").status_code == status
        assert web.delete("/api/link").status_code == status


def test_the_end_of_the_server_ends_a_reception(tmp_path: Any, sender: Sender) -> None:
    served = Served(tmp_path, by_hand=True)
    with httpx.Client(base_url=served.url, timeout=LONGEST_S) as client:
        begin(client, sender, "A.TXT")
    served.close()
    assert not (served.programs / "A.TXT").exists()
    assert os.path.exists(sender.port)
