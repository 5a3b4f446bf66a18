"""How long the language server takes to start, and to answer a key in a file of 20,000 lines.

Starts are CPU time of the server from its first import to its end: after the answer to
`initialize`, and after the findings of a file of the gantry.

The client of the keys makes no objects of what it is sent, which would take longer than the server
does: what is measured is real time from the message of the key, with a request for proposals
after it, to the answer. The check of the file runs meanwhile, as in an editor. The same is measured
on a computer whose cores are all busy with something else.
"""

import os
import queue
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, cast

from bench.cards import GANTRY
from bench.check import program
from bench.figures import RUNS, as_installed, at_most, children_s
from openacr.debugger.wire import read_message, write_message

LINES = 20_000
KEYS = "SET 34 : JOG VEL X12"
FINDINGS = "textDocument/publishDiagnostics"


class Client:
    """An editor without a window: a server that has answered `initialize`."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", "openacr", "lsp"]
        pipe = subprocess.PIPE
        self._server = subprocess.Popen(command, stdin=pipe, stdout=pipe, env=as_installed())
        self._out = cast("IO[bytes]", self._server.stdin)
        self._in = cast("IO[bytes]", self._server.stdout)
        self._come: queue.Queue[dict[str, object] | None] = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        self.ask("initialize", {"capabilities": {}})
        self.tell("initialized", {})

    def tell(self, method: str, params: object, **more: object) -> None:
        """Send a notification."""
        write_message(self._out, {"jsonrpc": "2.0", "method": method, "params": params, **more})

    def ask(self, method: str, params: object) -> None:
        """Send a request, and wait for its answer."""
        self.tell(method, params, id=method)
        self.wait("id", method)

    def wait(self, key: str, value: str) -> None:
        """Read up to the message that has this value, or to the end."""
        while (message := self._come.get()) is not None and message.get(key) != value:
            pass

    def _listen(self) -> None:
        """Read all the time, as editors do: what is not read would hold the server up."""
        while (message := read_message(self._in)) is not None:
            self._come.put(message)
        self._come.put(None)

    def open(self, uri: str, text: str) -> None:
        """Open a document."""
        item = {"uri": uri, "languageId": "acrobasic", "version": 1, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": item})

    def end(self) -> None:
        """Shut the server down, and wait for its end."""
        self.ask("shutdown", None)
        self.tell("exit", None)
        self._out.close()
        self._server.wait()


def _start(opened: Path | None = None) -> float:
    """CPU time of a server that answers `initialize`, and reports what it finds in a file."""
    used_s = children_s()
    client = Client()
    if opened is not None:
        client.open(opened.as_uri(), opened.read_text())
        client.wait("method", FINDINGS)
    client.end()
    return children_s() - used_s


def keys(path: Path) -> list[float]:
    """Seconds to the answer after each key."""
    client = Client()
    lines = program(LINES).split("\n")
    lines[LINES // 2] = ""
    client.open(path.as_uri(), "\n".join(lines))
    found = [_key(client, path.as_uri(), place) for place in range(len(KEYS))]
    client.end()
    return found[1:]  # the first one waits for the tables


def _key(client: Client, uri: str, at: int) -> float:
    here, there = ({"line": LINES // 2, "character": at + more} for more in (0, 1))
    change = {"range": {"start": here, "end": here}, "text": KEYS[at]}
    document = {"uri": uri, "version": at + 2}
    began = time.perf_counter()
    client.tell("textDocument/didChange", {"textDocument": document, "contentChanges": [change]})
    client.ask("textDocument/completion", {"textDocument": {"uri": uri}, "position": there})
    took_s = time.perf_counter() - began
    time.sleep(0.15 if at % 3 else 1.0)  # as keys come; checks begin between them
    return took_s


@contextmanager
def busy_cores() -> Iterator[None]:
    """A loop without end for each core."""
    loop = [sys.executable, "-c", "while True: pass"]
    loops = [subprocess.Popen(loop) for _ in range(os.cpu_count() or 1)]
    try:
        yield
    finally:
        for each in loops:
            each.kill()
            each.wait()


def _report(name: str, found: list[float]) -> None:
    at_most(f"{name}, usual", 1000 * statistics.median(found), 50.0, "ms")
    at_most(f"{name}, the longest", 1000 * max(found), 50.0, "ms")


def main() -> None:
    """The starts, the usual time and the longest of the keys."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["OPENACR_STORE"] = str(Path(folder, "sysvar.db"))
        for name, opened in (("answer", None), ("findings", GANTRY / "prog0.8k")):
            used_s = min(_start(opened) for _ in range(RUNS))
            at_most(f"language server: start to the first {name}", used_s, 0.5, "s")
        path = Path(folder, "prog0.8k")
        _report("a key in 20,000 lines", keys(path))
        with busy_cores():
            _report("  beside a busy loop on each core", keys(path))


if __name__ == "__main__":
    main()
