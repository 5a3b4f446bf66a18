"""How long the language server takes to start, and to answer a key in a file of 20,000 lines.

Starts are CPU time of the server from its first import to its end: after the answer to
`initialize`, and after the findings of a file of the gantry.

The client of the keys is a program of its own: what is measured is real time from the message of
the key, with a request for proposals after it, to the answer. The check of the file runs
meanwhile, as in an editor.
"""

import asyncio
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from lsprotocol import types
from pygls.lsp.client import LanguageClient

from bench.cards import GANTRY
from bench.check import program
from bench.figures import RUNS, as_installed, at_most, children_s

LINES = 20_000
KEYS = "SET 34 : JOG VEL X12"


async def _started() -> LanguageClient:
    """A client of a server that has answered `initialize`."""
    client = LanguageClient("bench", "1")
    await client.start_io(sys.executable, "-m", "openacr", "lsp", env=as_installed())
    await client.initialize_async(types.InitializeParams(capabilities=types.ClientCapabilities()))
    client.initialized(types.InitializedParams())
    return client


async def _ended(client: LanguageClient) -> None:
    await client.shutdown_async(None)
    client.exit(None)
    await client.stop()


async def _start(opened: Path | None = None) -> float:
    """CPU time of a server that answers `initialize`, and reports what it finds in a file."""
    used_s = children_s()
    client = await _started()
    if opened is not None:
        found = asyncio.Event()
        client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(lambda params: found.set())
        item = types.TextDocumentItem(opened.as_uri(), "acrobasic", 1, opened.read_text())
        client.text_document_did_open(types.DidOpenTextDocumentParams(item))
        await found.wait()
    await _ended(client)
    return children_s() - used_s


async def keys(path: Path) -> list[float]:
    """Seconds to the answer after each key."""
    client = await _started()
    client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(lambda params: None)
    lines = program(LINES).split("\n")
    lines[LINES // 2] = ""
    document = types.TextDocumentIdentifier(path.as_uri())
    item = types.TextDocumentItem(document.uri, "acrobasic", 1, "\n".join(lines))
    client.text_document_did_open(types.DidOpenTextDocumentParams(item))
    found = [await _key(client, document, place) for place in range(len(KEYS))]
    await _ended(client)
    return found[1:]  # the first one waits for the tables


async def _key(client: LanguageClient, document: types.TextDocumentIdentifier, at: int) -> float:
    here, there = (types.Position(LINES // 2, at + more) for more in (0, 1))
    change = types.TextDocumentContentChangePartial(types.Range(here, here), KEYS[at])
    versioned = types.VersionedTextDocumentIdentifier(at + 2, document.uri)
    began = time.perf_counter()
    client.text_document_did_change(types.DidChangeTextDocumentParams(versioned, [change]))
    await client.text_document_completion_async(types.CompletionParams(document, there))
    took_s = time.perf_counter() - began
    await asyncio.sleep(0.15 if at % 3 else 1.0)  # as keys come; checks begin between them
    return took_s


def main() -> None:
    """The starts, the usual time and the longest of the keys."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["OPENACR_STORE"] = str(Path(folder, "sysvar.db"))
        for name, opened in (("answer", None), ("findings", GANTRY / "prog0.8k")):
            used_s = min(asyncio.run(_start(opened)) for _ in range(RUNS))
            at_most(f"language server: start to the first {name}", used_s, 0.5, "s")
        found = asyncio.run(keys(Path(folder, "prog0.8k")))
    at_most("a key in 20,000 lines, usual", 1000 * statistics.median(found), 50.0, "ms")
    at_most("a key in 20,000 lines, the longest", 1000 * max(found), 50.0, "ms")


if __name__ == "__main__":
    main()
