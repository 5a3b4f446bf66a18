"""The life of a connection in messages, as the specification has it (JSON-RPC 2.0, LSP 3.17)."""

from __future__ import annotations

import asyncio
import json
import subprocess
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from tests import warm

from openacr.editing.document import Document, Place, Span, units_of
from openacr.editing.symbols import Finding
from openacr.language_server import features
from openacr.language_server.conversions import Columns, path_of, uri_of
from openacr.language_server.found import MOST_FINDINGS, Found
from openacr.language_server.server import Server

PATIENCE_S = 60.0
INITIALIZE = {"id": 0, "method": "initialize", "params": {"capabilities": {}}}
INITIALIZED: dict[str, Any] = {"method": "initialized", "params": {}}
SHUTDOWN = {"id": 1, "method": "shutdown"}
EXIT = {"method": "exit"}
URI = "file:///no-folder/prog0.8k"
DOCUMENT = {"uri": URI, "languageId": "acrobasic", "version": 1, "text": "PROGRAM\nDWL 1\nENDP\n"}
OPEN = {"method": "textDocument/didOpen", "params": {"textDocument": DOCUMENT}}
CHANGE = {
    "method": "textDocument/didChange",
    "params": {
        "textDocument": {"uri": URI, "version": 2},
        "contentChanges": [{"text": "PROGRAM\nINH 1\nENDP\n"}],
    },
}


def written(message: dict[str, Any]) -> bytes:
    body = json.dumps({"jsonrpc": "2.0"} | message).encode()
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


def hover(number: int) -> dict[str, Any]:
    where = {"textDocument": {"uri": URI}, "position": {"line": 1, "character": 1}}
    return {"id": number, "method": "textDocument/hover", "params": where}


def cancel(number: int) -> dict[str, Any]:
    return {"method": "$/cancelRequest", "params": {"id": number}}


class Writer:
    """Keeps what the server sends."""

    def __init__(self) -> None:
        self.sent: list[dict[str, Any]] = []

    def write(self, data: bytes) -> None:
        self.sent.append(json.loads(data.partition(b"\r\n\r\n")[2]))

    def close(self) -> None:
        pass


def talk(*messages: dict[str, Any]) -> dict[object, dict[str, Any]]:
    """What is sent for messages that come all at once, by number or method."""
    writer = Writer()
    server = Server()
    features.register(server)

    async def serve() -> None:
        reader = asyncio.StreamReader()
        reader.feed_data(b"".join(written(each) for each in messages))
        reader.feed_eof()
        await server._answer(reader, cast("Any", writer))

    asyncio.run(serve())
    return {each.get("id", each.get("method")): each for each in writer.sent}


def test_a_request_that_is_withdrawn_before_its_turn_is_not_computed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[str] = []
    monkeypatch.setattr(Server, "at", lambda server, uri, position: asked.append(uri))
    answers = talk(INITIALIZE, hover(5), cancel(5), cancel(6))
    assert answers[5]["error"]["code"] == types.LSPErrorCodes.RequestCancelled
    assert asked == []


def test_requests_that_wait_are_answered_from_the_text_they_were_asked_about() -> None:
    answers = talk(INITIALIZE, OPEN, hover(1), CHANGE, hover(2))
    assert answers[1]["result"]["contents"]["value"].startswith("**DWL**")
    assert answers[2]["result"]["contents"]["value"].startswith("**INH**")


def test_a_change_that_fails_does_not_end_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(server: Server, params: object) -> None:
        raise ValueError

    monkeypatch.setattr(Server, "changed", fail)
    answers = talk(INITIALIZE, OPEN, CHANGE, hover(1))
    assert "window/showMessage" in answers
    assert answers[1]["result"]["contents"]["value"].startswith("**DWL**")


def serve(text: bytes) -> subprocess.CompletedProcess[bytes]:
    """What a server does with all that a client sends before it dies."""
    return warm.run(["lsp"], input=text, capture_output=True, timeout=PATIENCE_S)


def test_an_exit_without_shutdown_is_a_failure() -> None:
    talked = b"".join(map(written, (INITIALIZE, INITIALIZED)))
    assert serve(talked + written(EXIT)).returncode == 1
    done = serve(talked + written(SHUTDOWN) + written(EXIT))
    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.parametrize(
    "rest",
    [
        b"", b"Content-Le", b"Content-Length: 900\r\n\r\n{",
        b"Content-Length: x\r\n\r\n{}", b"x" * 99_999,
    ],
)  # fmt: skip
def test_a_client_that_dies_in_a_message_ends_the_server(rest: bytes) -> None:
    done = serve(written(INITIALIZE) + written(OPEN) + rest)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b'"capabilities"' in done.stdout


def test_what_is_asked_last_is_answered() -> None:
    done = serve(written(INITIALIZE) + written(OPEN) + written(hover(7)))
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"**DWL**" in done.stdout


def test_a_client_that_reads_no_more_is_no_failure() -> None:
    server = warm.Popen(
        ["lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert server.stdout is not None
    server.stdout.close()
    talked = b"".join(map(written, (INITIALIZE, INITIALIZED, OPEN, hover(1))))
    _, said = server.communicate(talked, PATIENCE_S)
    assert said == b""
    assert server.returncode in (0, 1)  # 1 where the broken pipe was met within an answer


def test_of_very_many_findings_errors_are_sent_first_and_the_others_are_counted() -> None:
    document = Document.of(Path("a.8k"), "X\n" * (MOST_FINDINGS + 4))

    def finding(line: int) -> Finding:
        return Finding(Span(Place(line, 0), Place(line, 1)), str(line), is_warning=line != 1002)

    columns = Columns(units_of)
    some = columns.diagnostics(document, Found.of([*map(finding, range(MOST_FINDINGS))]))
    assert len(some) == MOST_FINDINGS
    many = columns.diagnostics(document, Found.of([*map(finding, range(MOST_FINDINGS + 3))]))
    assert [each.message for each in many[:2]] == ["1002", "0"]
    assert len(many) == MOST_FINDINGS + 1
    last = many[-1]
    assert last.message == "3 more findings are not shown"
    assert last.severity is types.DiagnosticSeverity.Information
    assert last.range.start.line == 999


@pytest.mark.parametrize(
    ("uri", "name"),
    [
        ("file:///a%20b/%C3%A9.8k", "/a b/\u00e9.8k"),
        ("file:///a%23b.8k", "/a#b.8k"),
        ("file://mill/share/x.8k", "//mill/share/x.8k"),
        ("untitled:Untitled-1", "/no-file/untitled:Untitled-1"),
        ("file://", "/no-file/file:__"),
        ("http://[", "/no-file/http:__["),
    ],
)
def test_a_uri_has_a_path_with_its_computer(uri: str, name: str) -> None:
    assert path_of(uri) == Path(name)


def test_a_path_has_the_uri_that_leads_to_it() -> None:
    for name in ("/a b/\u00e9#.8k", "/x%20y"):
        assert path_of(uri_of(Path(name))) == Path(name)
