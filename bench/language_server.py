"""How long the language server takes to start, and to answer a key in a file of 20,000 lines.

The client is a program of its own: what is measured is from the message of the key, with a request
for proposals after it, to the answer. The check of the file runs meanwhile, as in an editor.
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

from bench.check import program
from bench.figures import at_most

LINES = 20_000
KEYS = "SET 34 : JOG VEL X12"


async def answers(path: Path) -> tuple[float, list[float]]:
    """Seconds to the first answer, and to each answer after a key."""
    client = LanguageClient("bench", "1")
    began = time.perf_counter()
    await client.start_io(sys.executable, "-m", "openacr", "lsp")
    await client.initialize_async(types.InitializeParams(capabilities=types.ClientCapabilities()))
    started_s = time.perf_counter() - began
    client.initialized(types.InitializedParams())
    lines = program(LINES).split("\n")
    lines[LINES // 2] = ""
    document = types.TextDocumentIdentifier(path.as_uri())
    item = types.TextDocumentItem(document.uri, "acrobasic", 1, "\n".join(lines))
    client.text_document_did_open(types.DidOpenTextDocumentParams(item))
    found = [await _key(client, document, place) for place in range(len(KEYS))]
    await client.shutdown_async(None)
    client.exit(None)
    return started_s, found[1:]  # the first one waits for the tables


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
    """The usual time and the longest of the keys."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["OPENACR_STORE"] = str(Path(folder, "sysvar.db"))
        started_s, found = asyncio.run(answers(Path(folder, "prog0.8k")))
    at_most("language server: start to the first answer", started_s, 0.5, "s")
    at_most("a key in 20,000 lines, usual", 1000 * statistics.median(found), 50.0, "ms")
    at_most("a key in 20,000 lines, the longest", 1000 * max(found), 50.0, "ms")


if __name__ == "__main__":
    main()
