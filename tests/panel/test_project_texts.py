"""Programs of a project beside those of its card: what differs, what is stored in its folder."""

import json
import os
import pty
import re
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from tests.mill.live import Process
from tests.panel.bench import Served
from tests.waiting import LIMIT_S, until
from websockets.sync.client import connect
from websockets.typing import Origin

from openacr.client import Level
from openacr.client.errors import ChangedError
from openacr.client.stored import ListedLine
from openacr.errors import UserError
from openacr.panel.machine.project import of_project
from openacr.panel.work.project_texts import beside, states, store, text_of

EXAMPLES = Path(__file__).parents[2] / "examples"
ONE = "' counts\n\nPROGRAM\nREM forever\n ' by ones\nP1=P1+1\nENDP\n' the end\n"
LISTED = [ListedLine(10 * n, text) for n, text in enumerate(
    ("PROGRAM", "REM forever", "P1 = P1+1", "ENDP"), 1)]  # fmt: skip
TWO = [ListedLine(10, "DWL 1"), ListedLine(20, "DWL 2")]


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "setup.8k").write_text(
        "DIM P(100)\nDIM PROG1(2000)\nDIM PROG2(2000)\nDIM PROG3(2000)\nPROG2\n10 DWL 1\n20 DWL 2\n"
    )
    (tmp_path / "prog1.8k").write_text(ONE)
    return tmp_path


def differing(root: Path, listings: dict[str, list[ListedLine]]) -> list[str]:
    return [name for name, state in states(root, listings).items() if state != "equal"]


def test_each_text_is_equal_different_or_only_on_one_side(root: Path) -> None:
    more = [*LISTED, ListedLine(99, "END")]
    assert states(root, {"PROG1": LISTED, "PROG2": TWO, "PROG3": []}) == {
        "PROG1": "equal",
        "PROG2": "equal",
    }
    assert states(root, {"PROG1": more, "PROG2": [], "PLC1": TWO}) == {
        "PLC1": "card",
        "PROG1": "differs",
        "PROG2": "project",
    }
    rows = beside(root, "PROG1", more)
    assert [row.listed for row in rows if not row.is_same] == ["END"]
    assert all(row.listed == "" for row in beside(root, "PROG1", []))


def test_what_the_card_lists_in_another_spelling_is_no_difference(root: Path) -> None:
    assert differing(root, {"PROG1": LISTED, "PROG2": TWO, "PROG3": []}) == []


def test_changed_erased_and_new_programs_of_the_card_differ_in_their_order(root: Path) -> None:
    changed = [*LISTED[:2], ListedLine(30, "P1 = P1+2"), LISTED[3]]
    new = {"PLC0": [ListedLine(10, "BIT32 = BIT0")], "PROG10": TWO, "PROG3": TWO}
    assert differing(root, {"PROG1": changed, "PROG2": TWO[:1], **new}) == [
        "PLC0", "PROG1", "PROG2", "PROG3", "PROG10",
    ]  # fmt: skip
    assert differing(root, {"PROG2": TWO}) == ["PROG1"]


def test_the_text_of_a_program_is_that_of_its_file_with_the_comments_inside(root: Path) -> None:
    found = text_of(root, "PROG1", LISTED)
    assert (found.file, found.is_same, found.why_not) == ("prog1.8k", True, "")
    assert found.text == "PROGRAM\nREM forever\n ' by ones\nP1=P1+1\nENDP"
    assert not text_of(root, "PROG1", LISTED[:3]).is_same


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_another_text_keeps_what_is_around_it_in_the_file(root: Path, end: str) -> None:
    file = root / "PROG1.8K"
    (root / "prog1.8k").unlink()
    file.write_bytes(ONE.replace("\n", end).encode())
    version = text_of(root, "PROG1", ()).version
    stored = store(root, "PROG1", "PROGRAM\nP1 = 7\nENDP\n", version)
    wanted = "' counts\n\nPROGRAM\nP1 = 7\nENDP\n' the end\n"
    assert file.read_bytes() == wanted.replace("\n", end).encode()
    assert stored.version == text_of(root, "PROG1", ()).version != version
    assert sorted(each.name for each in root.iterdir()) == ["PROG1.8K", "setup.8k"]


def test_a_new_program_gets_a_file_of_its_own(root: Path) -> None:
    version = text_of(root, "PROG3", ()).version
    store(root, "PROG3", "10 DWL 1\n20 DWL 2", version)
    assert (root / "prog3.8k").read_text() == "10 DWL 1\n20 DWL 2\n"
    assert differing(root, {"PROG1": LISTED, "PROG2": TWO, "PROG3": TWO}) == []


def test_a_file_that_was_changed_since_and_a_program_in_the_set_up_are_refused(root: Path) -> None:
    version = text_of(root, "PROG1", ()).version
    (root / "prog1.8k").write_text(ONE.replace("+1", "+3"))
    with pytest.raises(ChangedError, match=r"prog1\.8k of the project was changed"):
        store(root, "PROG1", "10 DWL 1", version)
    assert "+3" in (root / "prog1.8k").read_text()
    in_setup = text_of(root, "PROG2", TWO)
    assert (in_setup.is_same, in_setup.text) == (True, "")
    with pytest.raises(UserError, match=r"PROG2 is in setup\.8k of the project: change it there"):
        store(root, "PROG2", "10 DWL 9", in_setup.version)
    assert not (root / "prog2.8k").exists()


# --- through the panel ----------------------------------------------------------------


@pytest.fixture
def gantry(tmp_path: Path) -> Path:
    return shutil.copytree(EXAMPLES / "gantry", tmp_path / "gantry")


@pytest.fixture
def served(gantry: Path, tmp_path: Path) -> Iterator[Served]:
    installation = of_project(gantry, store=None, programs=None, otherwise=tmp_path / "parts")
    panel = Served(tmp_path, installation=installation)
    yield panel
    panel.close()


def get(served: Served, call: str, **query: int) -> dict[str, object]:
    answer = httpx.get(f"{served.url}/api/{call}", params=query, timeout=LIMIT_S)
    assert answer.status_code == 200, answer.text
    found: dict[str, object] = answer.json()
    return found


def test_a_program_that_was_changed_on_the_card_is_stored_in_its_project(
    served: Served, gantry: Path
) -> None:
    same = [{"name": name, "state": "equal"} for name in ("PROG0", "PROG1")]
    assert get(served, "project") == {"name": "gantry", "differs": [], "texts": same}
    text = "PROGRAM\nP5 = 5\nENDP\n"
    served.call(lambda station: station.link.machine.card.download(text, to=Level.program(1)))
    assert get(served, "project")["differs"] == ["PROG1"]
    beside = get(served, "project/compare", program=1)
    assert (beside["name"], beside["is_equal"]) == ("PROG1", False)
    before = get(served, "project/text", program=1)
    assert (before["is_same"], before["file"]) == (False, "prog1.8k")
    body = {"name": "PROG1", "text": text, "version": before["version"]}
    url = f"{served.url}/api/project/text"
    assert httpx.post(url, json=body, timeout=LIMIT_S).json()["file"] == "prog1.8k"
    assert text in (gantry / "prog1.8k").read_text()
    assert get(served, "project")["differs"] == []
    again = httpx.post(url, json=body, timeout=LIMIT_S)
    assert (again.status_code, again.json()["error"]["code"]) == (409, "conflict")


def changed_on_the_card(url: str) -> None:
    """Clear a program of the card of a panel, as a browser does."""
    with connect(f"ws{url.removeprefix('http')}ws", origin=Origin(url.rstrip("/"))) as socket:
        socket.send(json.dumps({"id": 1, "cmd": "control.take", "args": {}}))
        socket.send(json.dumps({"id": 2, "cmd": "card.clear", "args": {"program": 1}}))
        while (answer := json.loads(socket.recv(LIMIT_S))).get("id") != 2:
            pass
        assert answer["ok"], answer


def test_ctrl_c_says_what_is_lost_and_asks_once_where_it_can_be_answered(
    gantry: Path, tmp_path: Path
) -> None:
    asked, terminal = pty.openpty()
    end_by_ctrl_c(gantry, tmp_path, subprocess.DEVNULL)
    end_by_ctrl_c(gantry, tmp_path, terminal, is_asked=True)
    os.close(asked)
    os.close(terminal)


def end_by_ctrl_c(gantry: Path, folder: Path, stdin: int, *, is_asked: bool = False) -> None:
    """Change a program of a panel of its own, then press Ctrl-C, twice where it asks."""
    words = ("panel", str(gantry), "--no-browser", "--port", "0")
    process = Process(*words, store=folder / "other.db", stdin=stdin)
    try:
        until(lambda: "panel http" in process.text, about="the panel listens")
        found = re.search(r"panel (http://127\.0\.0\.1:\d+/)", process.text)
        assert found is not None
        changed_on_the_card(found[1])
        process.signal(signal.SIGINT)
        if is_asked:
            until(lambda: "Ctrl-C again" in process.text, about="the question")
            assert httpx.get(f"{found[1]}api/me", timeout=LIMIT_S).status_code == 200
            process.signal(signal.SIGINT)
        assert process.ended() == 0
        assert "PROG1 of the card differs from the project gantry" in process.text
    finally:
        process.close()
