"""The part of the protocol that keeps texts: changes go to the engine instead of a second copy.

Requests are tasks of the loop (`features.py`), and wait there for those before them. A change of
a document waits in the same line: a request is answered from the text it was asked about.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from lsprotocol import types
from pygls.exceptions import FeatureNotificationError
from pygls.protocol import LanguageServerProtocol, lsp_method

if TYPE_CHECKING:
    from openacr.language_server.server import Server

logger = logging.getLogger(__name__)
Params = TypeVar("Params")


class Protocol(LanguageServerProtocol):
    """Opens, changes and closes documents of the server."""

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
