"""Where files are checked: short ones in a thread, long ones in a process that may die."""

import asyncio
import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from tests.language_server.test_server import Client, opened, position, run, serving
from tests.workers.orphans import is_there

from openacr.editing.document import Document
from openacr.editing.engine import Engine
from openacr.errors import UserError
from openacr.language_server import apart, checks
from openacr.language_server.apart import ANSWER_S, DIED, FROZEN, Apart
from openacr.language_server.checks import LONG_LINES, Checks
from openacr.language_server.found import NOTHING, Found

PATIENCE_S = 60.0
SUBJECT = Path("/no-folder/prog0.8k")


class Editor:
    """Keeps what it is sent."""

    machine: tuple[Path | None, str | None] = None, None

    def __init__(self, lines: int) -> None:
        self.engine = Engine()
        self.engine.open(SUBJECT, "\n".join(["DWL"] * lines))
        self.published: asyncio.Queue[Found] = asyncio.Queue()
        self.warned: list[str] = []

    def publish(self, path: Path, document: Document | None, found: Found) -> None:
        self.published.put_nowait(found)

    def warn(self, text: str) -> None:
        self.warned.append(text)


class Apartment:
    """Stands in for the process: answers, or fails, at once."""

    def __init__(self, failure: Exception | None = None) -> None:
        self.asked: list[Path] = []
        self.failure = failure

    async def found(self, subject: Path, documents: object) -> dict[Path, Found]:
        self.asked.append(subject)
        if self.failure is not None:
            raise self.failure
        return {subject: NOTHING}


def checked(
    monkeypatch: pytest.MonkeyPatch, editor: Editor, process: Apartment, times: int = 1
) -> list[Found]:
    """What is published of checks, one after the other."""
    monkeypatch.setattr(Apart, "found", lambda self, *given: process.found(*given))

    async def work() -> list[Found]:
        looking, found = Checks(editor), []
        for _ in range(times):
            looking.ask(SUBJECT, 0.0)
            async with asyncio.timeout(PATIENCE_S):
                found.append(await editor.published.get())
        looking.end()
        return found

    return asyncio.run(work())


@pytest.mark.parametrize(("lines", "asked"), [(LONG_LINES, []), (LONG_LINES + 1, [SUBJECT])])
def test_a_file_of_many_lines_is_checked_in_a_process(
    monkeypatch: pytest.MonkeyPatch, lines: int, asked: list[Path]
) -> None:
    process = Apartment()
    (found,) = checked(monkeypatch, Editor(lines), process)
    assert process.asked == asked
    assert (found is NOTHING) == bool(asked)


def test_lines_of_all_open_files_of_a_project_count_and_others_do_not(tmp_path: Path) -> None:
    editor = Editor(LONG_LINES)
    editor.engine.open(SUBJECT.with_name("prog1.8k"), "\n")
    documents = editor.engine.copies()
    looking = Checks(editor)
    assert not looking.is_long(SUBJECT, documents)
    assert looking.is_long(SUBJECT.parent, documents)
    assert not looking.is_long(SUBJECT.parent.parent, documents)


@pytest.mark.parametrize(("limit_s", "asked"), [(-1.0, [SUBJECT]), (PATIENCE_S, [])])
def test_a_short_file_whose_check_took_long_is_checked_in_a_process_from_then_on(
    monkeypatch: pytest.MonkeyPatch, limit_s: float, asked: list[Path]
) -> None:
    monkeypatch.setattr(checks, "LONG_S", limit_s)
    process = Apartment()
    first, second = checked(monkeypatch, Editor(1), process, times=2)
    assert process.asked == asked
    assert first.shown
    assert (second is NOTHING) == bool(asked)


@pytest.mark.parametrize("failure", [OSError("no semaphores"), ImportError("no processes")])
def test_where_no_process_can_be_started_long_files_are_checked_in_a_thread(
    monkeypatch: pytest.MonkeyPatch, failure: Exception
) -> None:
    process = Apartment(failure)
    (found,) = checked(monkeypatch, Editor(LONG_LINES + 1), process)
    assert process.asked == [SUBJECT]
    assert found.left_out == LONG_LINES + 1 - 1000


def test_an_editor_is_warned_once_of_a_file_that_cannot_be_checked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    editor, process = Editor(LONG_LINES + 1), Apartment(UserError(DIED))
    monkeypatch.setattr(Apart, "found", lambda self, *given: process.found(*given))

    async def work() -> None:
        looking = Checks(editor)
        for failures in (2, 1):
            process.failure = UserError(DIED)
            for _ in range(failures):
                await looking.check(SUBJECT)
            process.failure = None
            await looking.check(SUBJECT)
        looking.end()

    asyncio.run(work())
    assert editor.warned == [f"prog0.8k is not checked until its next change: {DIED}"] * 2
    assert editor.published.qsize() == 2


class Background:
    """Stands in for a process that is frozen or dies, as often as it is said."""

    def __init__(self, *failures: Exception | None) -> None:
        self.failures = list(failures)
        self.closed = 0
        self.given: list[Any] = []

    async def run(self, work: object, *given: Any) -> dict[Path, Found]:
        self.given.append(given)
        failure = self.failures.pop(0) if self.failures else ValueError
        if failure is None:
            await asyncio.Event().wait()
        elif isinstance(failure, UserError):
            raise failure
        return {SUBJECT: NOTHING}

    def close(self) -> None:
        self.closed += 1


def asked_apart(
    monkeypatch: pytest.MonkeyPatch, process: Background, times: int = 1
) -> tuple[Apart, list[object]]:
    """The answers of checks apart, or why there are none."""
    monkeypatch.setattr(apart, "Background", lambda _killed: process)
    monkeypatch.setattr(apart, "ANSWER_S", 0.01)
    beside = Apart(None, None)

    async def work() -> list[object]:
        found: list[object] = []
        for _ in range(times):
            try:
                found.append(await beside.found(SUBJECT, {}))
            except UserError as error:
                found.append(str(error))
        return found

    return beside, asyncio.run(work())


def test_a_process_that_dies_once_is_asked_again_and_one_that_dies_twice_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    died = UserError(DIED)
    once, twice = Background(died), Background(died, died)
    assert asked_apart(monkeypatch, once)[1] == [{SUBJECT: NOTHING}]
    assert asked_apart(monkeypatch, twice)[1] == [DIED]
    assert (len(once.given), len(twice.given)) == (2, 2)
    assert (once.closed, twice.closed) == (0, 0)


def test_a_process_that_does_not_answer_is_replaced_and_given_twice_the_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    frozen = Background(None, None, None)
    beside, found = asked_apart(monkeypatch, frozen, times=2)
    assert found == [FROZEN, {SUBJECT: NOTHING}]
    assert frozen.closed == 3
    assert beside.patience_s(SUBJECT) == 0.08
    assert beside.patience_s(SUBJECT.parent) == 0.01
    assert ANSWER_S >= 10.0  # of a computer that is loaded


def test_a_process_gets_the_texts_of_the_subject_and_those_beside_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    process = Background()
    monkeypatch.setattr(apart, "Background", lambda _killed: process)
    project, file = Path("/a"), Path("/b/x.nc")
    inside, beside, beyond = Path("/a/prog0.8k"), Path("/b/y.nc"), Path("/a/b/prog0.8k")
    documents = {each: Document.of(each, "") for each in (inside, file, beside, beyond)}

    async def work() -> None:
        for subject in (project, file):
            await Apart(None, "auto").found(subject, documents)

    asyncio.run(work())
    assert [each[:2] for each in process.given] == [
        ((None, "auto"), project), ((None, "auto"), file),
    ]  # fmt: skip
    assert [set(each[2]) for each in process.given] == [{inside}, {file, beside}]


# --- a server as an editor starts it ------------------------------------------------------


def children(process: int) -> list[int]:
    """The processes that a process has started from its first thread or another one."""
    found = Path(f"/proc/{process}/task").glob("*/children")
    return [int(word) for each in found for word in each.read_text().split()]


def workers(process: int) -> list[int]:
    """Those that compute."""
    return [
        each for each in children(process)
        if b"spawn_main" in Path(f"/proc/{each}/cmdline").read_bytes()
    ]  # fmt: skip


async def until(is_so: Callable[[], Any]) -> Any:
    end_s = time.monotonic() + PATIENCE_S
    while not (found := is_so()):
        assert time.monotonic() < end_s
        await asyncio.sleep(0.005)
    return found


async def typed(client: Client, document: types.TextDocumentIdentifier, text: str) -> None:
    """Type letters in the first line; each has an answer before the next one."""
    for version, letter in enumerate(text, start=2):
        here = types.Range(position(0, version - 2), position(0, version - 2))
        change = types.TextDocumentContentChangePartial(here, letter)
        versioned = types.VersionedTextDocumentIdentifier(version, document.uri)
        client.text_document_did_change(types.DidChangeTextDocumentParams(versioned, [change]))
        where = types.CompletionParams(document, position(0, version - 1))
        found = await asyncio.wait_for(client.text_document_completion_async(where), PATIENCE_S)
        assert isinstance(found, types.CompletionList)


@pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in /proc")
def test_keys_are_answered_while_a_check_is_under_way_and_its_process_is_replaced(
    store: Path, tmp_path: Path
) -> None:
    path = tmp_path / "a.8k"

    async def work() -> None:
        async with serving(store) as client:
            server = client._server.pid  # type: ignore[union-attr]
            document = opened(client, path, "\n" + "DWL 1\n" * LONG_LINES)
            (process,) = await until(lambda: workers(server))
            os.kill(process, signal.SIGSTOP)  # its check is under way until it is killed
            await typed(client, document, "SET 34")
            while not client.published.empty():
                assert client.published.get_nowait().version in (None, 1)  # of a check before
            os.kill(process, signal.SIGKILL)
            assert await client.findings(document.uri, 7) == []
            (other,) = workers(server)
            assert other != process
            assert not is_there(process)

    run(work)


@pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in /proc")
def test_a_short_file_starts_no_process_and_that_of_a_long_one_ends_with_the_server(
    store: Path, tmp_path: Path
) -> None:
    found: list[int] = []

    async def work() -> None:
        async with serving(store) as client:
            server = client._server.pid  # type: ignore[union-attr]
            short = opened(client, tmp_path / "a.8k", "QQ 1\n" * (LONG_LINES - 1))
            assert await client.findings(short.uri, 1)
            assert children(server) == []
            long = opened(client, tmp_path / "b.8k", "QQ 1\n" * LONG_LINES)
            published = await client.findings(long.uri, 1)
            assert [each.message for each in published[-2:]] == [
                "Unknown command", "1000 more findings are not shown",
            ]  # fmt: skip
            found.extend(workers(server))

    run(work)
    (process,) = found
    asyncio.run(until(lambda: not is_there(process)))
