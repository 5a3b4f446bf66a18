"""The server: documents by URI, and what their changes cause."""

from __future__ import annotations

import asyncio
import logging
import sys
import threading
from collections.abc import Callable
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from lsprotocol import types
from pygls.exceptions import FeatureNotificationError
from pygls.io_ import StdoutWriter, run_async
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, lsp_method

from openacr.editing.document import Document, Edit, Place, units_of
from openacr.language_server.checks import Checks
from openacr.language_server.conversions import Columns, path_of, uri_of
from openacr.language_server.streams import stream_of

if TYPE_CHECKING:
    import socket

    from openacr.editing.completions import Item
    from openacr.editing.engine import Engine
    from openacr.language_server.found import Found

NAME = "openacr"
PREPARE_S = 0.3  # after a file is opened, when its check is under way
Params = TypeVar("Params")
logger = logging.getLogger(__name__)


def _bytes_of(text: str) -> int:
    return len(text.encode(errors="replace"))


WIDTHS = {"utf-8": _bytes_of, "utf-16": units_of, "utf-32": len}


class Server(LanguageServer):
    """Answers one client."""

    def __init__(self, store: Path | None = None, dialect: str | None = None) -> None:
        super().__init__(NAME, version(NAME), protocol_cls=Protocol)
        self.machine = store, dialect
        self.checks = Checks(self)
        self.columns = Columns(units_of)
        self.proposed: list[Item] = []  # last, to say more of one of them
        self._uris: dict[Path, str] = {}
        self._versions: dict[Path, int] = {}
        self._tasks: set[asyncio.Task[None]] = set()

    @cached_property
    def engine(self) -> Engine:
        """What answers; imported when the first document comes, so that the server starts soon."""
        from openacr.editing.engine import Engine

        return Engine(*self.machine)

    def start_at(self, listener: socket.socket) -> None:
        """Serve the first client of a socket that listens, until it leaves; no other gets in."""
        connection, _ = listener.accept()
        listener.close()
        asyncio.run(self._serve_connection(connection))

    def start_here(self) -> None:
        """Serve the client at the standard streams, until it leaves."""
        asyncio.run(self._serve_streams())

    async def _serve_connection(self, connection: socket.socket) -> None:
        reader, writer = await asyncio.open_connection(sock=connection)
        await self._answer(reader, writer)

    async def _serve_streams(self) -> None:
        # Unbuffered: a thread that waits in a buffer would hold its lock at the end.
        incoming = open(sys.stdin.fileno(), "rb", buffering=0, closefd=False)
        await self._answer(stream_of(incoming), StdoutWriter(sys.stdout.buffer))

    async def _answer(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter | StdoutWriter
    ) -> None:
        self._stop_event = threading.Event()
        self.protocol.set_writer(writer)
        try:
            await run_async(
                self._stop_event, reader, self.protocol, error_handler=self.report_server_error
            )
            for _ in range(2):  # what was asked last is computed, and sent
                await asyncio.sleep(0)
        except (OSError, EOFError, ValueError) as failure:
            logger.warning("the client is gone: %s", failure)
        finally:
            self.checks.end()
            self.shutdown()  # type: ignore[no-untyped-call]
            writer.close()

    def agree(self) -> None:
        """Count columns in the unit that was agreed on."""
        encoding = self.server_capabilities.position_encoding or "utf-16"
        name = encoding if isinstance(encoding, str) else encoding.value
        self.columns = Columns(WIDTHS.get(str(name), units_of))

    # documents

    def document(self, uri: str) -> Document:
        """An open document; UserError if it is not open."""
        return self.engine.document(path_of(uri))

    def at(self, uri: str, position: types.Position) -> tuple[Document, Place]:
        """A document and a place in it."""
        document = self.document(uri)
        return document, self.columns.place(document, position)

    def uri(self, path: Path) -> str:
        """The URI of a file, as the client writes it."""
        return self._uris.get(path) or uri_of(path)

    def opened(self, found: types.TextDocumentItem) -> None:
        """Take over a document."""
        path = path_of(found.uri)
        self._uris[path], self._versions[path] = found.uri, found.version
        self.engine.open(path, found.text, found.language_id)
        self.checks.ask(self.engine.subject(path), 0.0)
        task = asyncio.get_running_loop().create_task(self._prepare(path))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _prepare(self, path: Path) -> None:
        """Read ahead in a file between what the client asks."""
        await asyncio.sleep(PREPARE_S)
        for _ in self.engine.prepare(path):
            await asyncio.sleep(0.0)

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Change a document; one that was never opened is left alone."""
        path = path_of(params.text_document.uri)
        if path not in self.engine.files.unsaved:
            return
        self._versions[path] = params.text_document.version
        document = self.engine.document(path)
        for change in params.content_changes:
            if isinstance(change, types.TextDocumentContentChangeWholeDocument):
                document.replace(change.text)
            else:
                span = self.columns.span(document, change.range)
                document.apply(Edit(span, change.text))
        self.engine.files.forget()
        self.checks.ask(self.engine.subject(path))

    def closed(self, uri: str) -> None:
        """Close a document; the file on the disk counts again."""
        path = path_of(uri)
        if path not in self.engine.files.unsaved:
            return
        subject = self.engine.subject(path)
        self.engine.close(path)
        self._uris.pop(path, None)
        self._versions.pop(path, None)
        self.checks.drop(path)
        if subject != path and any(each.parent == subject for each in self.engine.files.unsaved):
            self.checks.ask(subject)

    def disk_changed(self) -> None:
        """Files have changed on the disk: read and check again."""
        self.engine.files.forget()
        for subject in {self.engine.subject(path) for path in self.engine.files.unsaved}:
            self.checks.ask(subject)

    # what is wrong

    def warn(self, text: str) -> None:
        """Say what the user of the editor has to know."""
        kind = types.MessageType.Warning
        self.window_show_message(types.ShowMessageParams(kind, f"openacr: {text}"))

    def publish(self, path: Path, document: Document | None, found: Found) -> None:
        """Send what was found in a file."""
        text = document or self.engine.files.document(path) or Document.of(path, "")
        present = self.engine.files.unsaved.get(path)
        is_present = present is not None and present.revision == text.revision
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(
                self.uri(path),
                self.columns.diagnostics(text, found),
                version=self._versions.get(path) if is_present else None,
            )
        )


class Protocol(LanguageServerProtocol):
    """The part of the protocol that keeps texts: changes go to the engine, there is no second copy.

    Requests are tasks of the loop (`features.py`), and wait there for those before them. A change
    of a document waits in the same line: a request is answered from the text it was asked about.
    """

    _server: Server

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> None:
        """A document is open now."""
        self._in_turn(self._server.opened, params.text_document)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        """A document has changed."""
        self._in_turn(self._server.changed, params)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> None:
        """A document is closed."""
        self._in_turn(self._server.closed, params.text_document.uri)

    def _in_turn(self, change: Callable[[Params], None], params: Params) -> None:
        """Make a change after what has come before it."""
        asyncio.get_running_loop().call_soon(self._make, change, params)

    def _make(self, change: Callable[[Params], None], params: Params) -> None:
        try:
            change(params)
        except Exception as error:  # one change that fails must not end the others
            logger.exception("a document could not be changed")
            self._server.report_server_error(error, FeatureNotificationError)
