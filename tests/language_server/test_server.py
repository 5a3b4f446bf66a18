"""The language server as an editor meets it: a real process, a real client."""

import asyncio
import socket
import subprocess
import sys
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.client import LanguageClient
from tests import warm

from openacr.source_check import check

COMMAND = [sys.executable, "-m", "openacr", "lsp"]
PATIENCE_S = 60.0
SETUP = "SYS\nDIM PROG0(4000)\nDIM DEF(5)\n#DEFINE lamp BIT34\nPROG0\nATTACH MASTER0\n"
PROGRAM = (
    'PROGRAM\r\n_Head\r\nPRINT "\U0001d11e\u00e9" : SET lamp : lmp = 1\r\nGOTO Head\r\nENDP\r\n'
)


class Client(LanguageClient):
    """A client that keeps what the server publishes."""

    def __init__(self) -> None:
        super().__init__("tests", "1")
        self.published: asyncio.Queue[types.PublishDiagnosticsParams] = asyncio.Queue()

        @self.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def publish(params: types.PublishDiagnosticsParams) -> None:
            self.published.put_nowait(params)

    async def findings(self, uri: str, version: int | None) -> list[types.Diagnostic]:
        """What is published for a version of a document."""
        while True:
            found = await asyncio.wait_for(self.published.get(), PATIENCE_S)
            if found.uri == uri and found.version == version:
                return list(found.diagnostics)


@asynccontextmanager
async def serving(store: Path, encodings: list[str] | None = None) -> AsyncIterator[Client]:
    client = Client()
    await client.start_io(*COMMAND, "--store", str(store))
    general = types.GeneralClientCapabilities(position_encodings=encodings)
    capabilities = types.ClientCapabilities(general=general)
    answer = await client.initialize_async(types.InitializeParams(capabilities=capabilities))
    client.answer = answer  # type: ignore[attr-defined]
    client.initialized(types.InitializedParams())
    try:
        yield client
        await client.shutdown_async(None)
        client.exit(None)
        await asyncio.wait_for(client.stop(), PATIENCE_S)  # type: ignore[no-untyped-call]
    finally:
        if client._server is not None and client._server.returncode is None:
            client._server.kill()


def run(question: Callable[[], Awaitable[None]]) -> None:
    asyncio.run(asyncio.wait_for(question(), 2 * PATIENCE_S))


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "setup.8k").write_text(SETUP)
    (tmp_path / "prog0.8k").write_bytes(PROGRAM.encode())
    return tmp_path


def opened(
    client: Client, path: Path, text: str, language: str = ""
) -> types.TextDocumentIdentifier:
    item = types.TextDocumentItem(path.as_uri(), language, 1, text)
    client.text_document_did_open(types.DidOpenTextDocumentParams(item))
    return types.TextDocumentIdentifier(path.as_uri())


def position(line: int, character: int) -> types.Position:
    return types.Position(line, character)


def span(line: int, start: int, end: int) -> types.Range:
    return types.Range(position(line, start), position(line, end))


@pytest.mark.parametrize(
    ("encodings", "column"), [(None, 25), (["utf-16"], 25), (["utf-32"], 24), (["utf-8"], 28)]
)
def test_an_editor_works_with_a_program(
    project: Path, store: Path, encodings: list[str] | None, column: int
) -> None:
    path = project / "prog0.8k"
    at = column - 11  # of SET

    async def work() -> None:
        async with serving(store, encodings) as client:
            document = opened(client, path, PROGRAM)
            (found,) = await client.findings(document.uri, 1)
            (expected,) = check(project)
            assert found.message == f"{expected.message} ({expected.hint})"
            assert found.range == span(2, column, column + 3)
            assert found.severity is types.DiagnosticSeverity.Error

            actions = await client.text_document_code_action_async(
                types.CodeActionParams(document, found.range, types.CodeActionContext([]))
            )
            assert actions is not None
            (action,) = actions
            assert isinstance(action, types.CodeAction)
            edits = (action.edit.changes or {})[document.uri] if action.edit else []
            assert list(edits) == [types.TextEdit(found.range, "lamp")]

            versioned = types.VersionedTextDocumentIdentifier(2, document.uri)
            change = types.TextDocumentContentChangePartial(found.range, "lamp")
            client.text_document_did_change(types.DidChangeTextDocumentParams(versioned, [change]))
            assert await client.findings(document.uri, 2) == []

            hover = await client.text_document_hover_async(
                types.HoverParams(document, position(2, at))
            )
            assert hover is not None
            assert isinstance(hover.contents, types.MarkupContent)
            assert hover.contents.value.startswith("**SET**")
            assert hover.range == span(2, at, at + 3)

            where = await client.text_document_definition_async(
                types.DefinitionParams(document, position(2, at + 5))
            )
            found_places = list(cast("list[types.Location]", where))
            expected_uri = (project / "setup.8k").as_uri()
            assert found_places == [types.Location(expected_uri, span(3, 8, 12))]

            renamed = await client.text_document_rename_async(
                types.RenameParams(document, position(1, 2), "Begin")
            )
            assert renamed is not None
            changed = {uri: list(each) for uri, each in (renamed.changes or {}).items()}
            assert changed == {
                document.uri: [
                    types.TextEdit(span(1, 1, 5), "Begin"),
                    types.TextEdit(span(3, 5, 9), "Begin"),
                ]
            }
            with pytest.raises(JsonRpcException, match="a letter first"):
                await client.text_document_rename_async(
                    types.RenameParams(document, position(1, 2), "1")
                )

    run(work)


def test_all_questions_have_answers(project: Path, store: Path) -> None:
    path = project / "prog0.8k"

    async def work() -> None:
        async with serving(store) as client:
            document = opened(client, path, PROGRAM)
            completion = await client.text_document_completion_async(
                types.CompletionParams(document, position(3, 3))
            )
            assert isinstance(completion, types.CompletionList)
            items = {item.label: item for item in completion.items}
            assert "GOTO" in items
            resolved = await client.completion_item_resolve_async(items["GOTO"])
            assert isinstance(resolved.documentation, types.MarkupContent)
            assert resolved.documentation.value.startswith("**GOTO**")
            unknown = await client.completion_item_resolve_async(types.CompletionItem("NONE"))
            assert unknown.documentation is None

            help_ = await client.text_document_signature_help_async(
                types.SignatureHelpParams(document, position(2, 17))
            )
            assert help_ is not None
            assert [each.label for each in help_.signatures] == ["SET bit ..."]

            references = await client.text_document_references_async(
                types.ReferenceParams(types.ReferenceContext(False), document, position(1, 2))
            )
            assert list(references or ()) == [types.Location(document.uri, span(3, 5, 9))]
            highlights = await client.text_document_document_highlight_async(
                types.DocumentHighlightParams(document, position(1, 2))
            )
            assert [each.range for each in highlights or []] == [span(1, 1, 5), span(3, 5, 9)]
            prepared = await client.text_document_prepare_rename_async(
                types.PrepareRenameParams(document, position(1, 2))
            )
            assert prepared == span(1, 1, 5)

            symbols = await client.text_document_document_symbol_async(
                types.DocumentSymbolParams(document)
            )
            assert [each.name for each in symbols or []] == ["PROG0"]
            folds = await client.text_document_folding_range_async(
                types.FoldingRangeParams(document)
            )
            assert [(each.start_line, each.end_line) for each in folds or []] == [(0, 4)]
            edits = await client.text_document_formatting_async(
                types.DocumentFormattingParams(document, types.FormattingOptions(4, True))
            )
            assert edits
            assert edits[0] == types.TextEdit(span(1, 0, 5), " _Head")

            tokens = await client.text_document_semantic_tokens_range_async(
                types.SemanticTokensRangeParams(
                    document, types.Range(position(1, 0), position(2, 0))
                )
            )
            assert tokens is not None
            assert list(tokens.data[:5]) == [1, 0, 5, tokens.data[3], 1]
            everything = await client.text_document_semantic_tokens_range_async(
                types.SemanticTokensRangeParams(
                    document, types.Range(position(0, 0), position(99, 0))
                )
            )
            full = await client.text_document_semantic_tokens_full_async(
                types.SemanticTokensParams(document)
            )
            assert everything is not None and full is not None
            assert list(full.data) == list(everything.data)
            assert len(full.data) > len(tokens.data)
            hints = await client.text_document_inlay_hint_async(
                types.InlayHintParams(document, types.Range(position(0, 0), position(9, 0)))
            )
            assert list(hints or ()) == []

            part = opened(client, project / "a.nc", "G1 X1\nGOTO 9\nM2\n")
            found = await client.findings(part.uri, 1)
            assert [each.code for each in found][-1:] == ["E220"]

    run(work)


STRANGE = (
    b'{"jsonrpc":"2.0","id":901,"method":"openacr/unknown","params":{"a":1}}',
    b'{"jsonrpc":"2.0","id":902,"method":"textDocument/hover","params":{"wrong":true}}',
    b'{"jsonrpc":"2.0","id":903,"method":"textDocument/hover"}',
    b'{"jsonrpc":"2.0","method":"$/whatever","params":[1]}',
    b'{"jsonrpc":"2.0","method":"textDocument/didChange","params":{}}',
    b'{"id":',
    b"[]",
    b'"\xff"',
)


def send(client: Client, body: bytes) -> None:
    assert client._server is not None
    assert client._server.stdin is not None
    client._server.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)


def test_nothing_ends_the_server(project: Path, store: Path) -> None:
    path = project / "prog0.8k"

    async def work() -> None:
        async with serving(store) as client:
            closed = types.TextDocumentIdentifier((project / "plc0.8k").as_uri())
            for uri in (closed.uri, "untitled:Untitled-1", "", "http://[", "file://", "x"):
                document = types.TextDocumentIdentifier(uri)
                asked = types.HoverParams(document, position(0, 0))
                assert await client.text_document_hover_async(asked) is None
            for body in STRANGE:
                send(client, body)
            client.text_document_did_close(types.DidCloseTextDocumentParams(closed))
            versioned = types.VersionedTextDocumentIdentifier(7, closed.uri)
            whole = types.TextDocumentContentChangeWholeDocument("X1")
            client.text_document_did_change(types.DidChangeTextDocumentParams(versioned, [whole]))

            document = opened(client, path, "PROGRAM\n\x00\ud800\n")
            far = types.Range(position(5, 700), position(99, 0))
            changes: list[Any] = [
                types.TextDocumentContentChangePartial(far, "X\n"),
                types.TextDocumentContentChangeWholeDocument("PROGRAM\nVEL 1\nENDP"),
            ]
            versioned = types.VersionedTextDocumentIdentifier(2, document.uri)
            client.text_document_did_change(types.DidChangeTextDocumentParams(versioned, changes))
            for where in (position(1, 1), position(1, 99)):
                hover = await client.text_document_hover_async(types.HoverParams(document, where))
                assert hover is None or "VEL" in str(hover.contents)
            beyond = types.HoverParams(document, position(99, 0))
            await client.text_document_hover_async(beyond)
            assert await client.findings(document.uri, 2) == []

            untitled = types.TextDocumentItem("untitled:Untitled-1", "acrobasic", 1, "QQ 1\n")
            client.text_document_did_open(types.DidOpenTextDocumentParams(untitled))
            assert [each.message for each in await client.findings(untitled.uri, 1)] == [
                "Unknown command"
            ]

    run(work)


def test_a_file_on_the_disk_counts_after_it_was_closed(project: Path, store: Path) -> None:
    async def work() -> None:
        async with serving(store) as client:
            setup = opened(client, project / "setup.8k", SETUP.replace("lamp", "lmp"))
            program = opened(client, project / "prog0.8k", PROGRAM)
            while True:
                found = await client.findings(program.uri, 1)
                if [each.range.start.line for each in found] == [2] and "lmp" in found[0].message:
                    break
            client.text_document_did_close(types.DidCloseTextDocumentParams(setup))
            while "lamp" not in (found := await client.findings(program.uri, 1))[0].message:
                pass
            assert [each.range for each in found] == [span(2, 25, 28)]
            (project / "setup.8k").write_text(SETUP + "#DEFINE lmp P0\nDIM P(1)\n")
            event = types.FileEvent(setup.uri, types.FileChangeType.Changed)
            client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([event]))
            while await client.findings(program.uri, 1):
                pass

    run(work)


@contextmanager
def listening(*options: str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        port = found.getsockname()[1]
    process = warm.Popen(["lsp", "--tcp", str(port), *options], stderr=subprocess.PIPE, text=True)
    try:
        assert process.stderr is not None
        assert process.stderr.readline() == f"listening lsp=127.0.0.1:{port}\n"
        yield process, port
    finally:
        process.kill()
        process.communicate()


def test_the_port_is_open_when_it_is_named_and_a_client_that_leaves_ends_the_server() -> None:
    with listening() as (process, port):
        socket.create_connection(("127.0.0.1", port)).close()
        assert process.wait(PATIENCE_S) == 0


def test_a_port_of_this_computer_serves_one_client(store: Path) -> None:
    with listening("--store", str(store)) as (process, port):

        async def work() -> None:
            client = Client()
            await client.start_tcp("127.0.0.1", port)
            capabilities = types.ClientCapabilities()
            answer = await client.initialize_async(
                types.InitializeParams(capabilities=capabilities)
            )
            assert answer.server_info is not None
            assert answer.server_info.name == "openacr"
            assert answer.capabilities.hover_provider
            tokens = answer.capabilities.semantic_tokens_provider
            assert tokens is not None and (tokens.full, tokens.range) == (True, True)
            with pytest.raises(ConnectionRefusedError):
                await Client().start_tcp("127.0.0.1", port)
            await client.shutdown_async(None)
            client.exit(None)
            await client.stop()  # type: ignore[no-untyped-call]

        run(work)
        assert process.wait(PATIENCE_S) == 0


def test_a_port_in_use_is_refused_as_by_all_commands_that_listen() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = warm.run(
            ["lsp", "--tcp", str(port)], capture_output=True, text=True, timeout=PATIENCE_S
        )
    said = f"error: port {port} on 127.0.0.1 is in use (is it running already?); choose another one"
    assert (done.returncode, done.stderr.splitlines()[-1]) == (2, f"{said} with --tcp PORT")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--tcp", "70000"], "error: --tcp 70000: a port is a number from 1 to 65535\n"),
        (["--log", "/none/a.log"], "error: /none/a.log: No such file or directory\n"),
    ],
)
def test_a_wrong_option_is_refused(options: list[str], message: str) -> None:
    done = warm.run(["lsp", *options], capture_output=True, text=True, timeout=PATIENCE_S)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", message)


def test_the_end_of_its_input_ends_the_server() -> None:
    done = subprocess.run(COMMAND, input=b"", capture_output=True, timeout=PATIENCE_S, check=False)
    assert done.returncode == 0
    assert done.stdout == b""
