"""The panel: age of the read-out, answer to a command, and what the server costs."""

import asyncio
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import websockets

from bench.figures import at_most, percentile, value_only

SECONDS = 10.0
HEAD = struct.Struct("<BBHIdd")
BROWSERS = (1, 4)
TOPICS = {1: "status", 4: "scope"}
# Four channels of 5,000 samples, 1 ms apart, again and again.
SCOPE = {
    "channels": [12288, 12290, 12544, 12546],
    "period_ms": 1,
    "samples": 5000,
    "trigger": None,
}


class _Browser:
    """A browser without a picture: it acknowledges frames and now and then asks something."""

    def __init__(self, socket: Any) -> None:
        self._socket = socket
        self.ages_ms: list[float] = []
        self.answers_ms: list[float] = []
        self._asked_s = 0.0

    async def run(self, seconds: float) -> None:
        await self._send({"id": 1, "cmd": "sub", "args": {"topic": "status", "hz": 25}})
        await self._send({"id": 3, "cmd": "sub", "args": {"topic": "scope", "hz": 10}})
        await self._send({"id": 4, "cmd": "scope.arm", "args": SCOPE})
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            message = await self._socket.recv()
            if isinstance(message, bytes):
                await self._drawn(message)
            elif '"id":2,' in message and self._asked_s:
                self.answers_ms.append(1000.0 * (time.monotonic() - self._asked_s))
                self._asked_s = 0.0

    async def _drawn(self, frame: bytes) -> None:
        topic, _, _, seq, _, age_ms = HEAD.unpack_from(frame)
        await self._send({"ack": TOPICS[topic], "seq": seq})
        if TOPICS[topic] == "scope":
            return
        self.ages_ms.append(age_ms)
        if not self._asked_s:
            self._asked_s = time.monotonic()
            await self._send({"id": 2, "cmd": "jog.stop", "args": {}})

    async def _send(self, data: dict[str, Any]) -> None:
        await self._socket.send(json.dumps(data))


async def _measure(url: str, count: int) -> list[_Browser]:
    sockets = [await websockets.connect(url) for _ in range(count)]
    browsers = [_Browser(socket) for socket in sockets]
    await asyncio.gather(*(browser.run(SECONDS) for browser in browsers))
    for socket in sockets:
        await socket.close()
    return browsers


@dataclass(slots=True)
class Share:
    """Processor time of a panel, in seconds: of its web server, and of card and control."""

    server_s: float = 0.0
    control_s: float = 0.0

    @classmethod
    def of(cls, pid: int) -> "Share":
        """The times so far: the server is the first thread of the process."""
        found = cls()
        for task in Path(f"/proc/{pid}/task").glob("*"):
            fields = (task / "stat").read_text().rpartition(")")[2].split()
            seconds = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
            if task.name == str(pid):
                found.server_s += seconds
            else:
                found.control_s += seconds
        return found

    def since(self, before: "Share", seconds: float) -> tuple[float, float]:
        """Per cent of one processor since then: server, card and control."""
        server, control = self.server_s - before.server_s, self.control_s - before.control_s
        return 100.0 * server / seconds, 100.0 * control / seconds


@contextmanager
def served(*words: str) -> Iterator[tuple[str, int]]:
    """A panel in a process of its own: host with port, and process id."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["panel", "--no-browser", "--port", "0", "--store", f"{folder}/sysvar.db", *words]
        process = subprocess.Popen(
            [sys.executable, "-m", "openacr", *command], stdout=subprocess.PIPE, text=True
        )
        try:
            line = process.stdout.readline() if process.stdout is not None else ""
            found = re.search(r"http://(\S+)/", line)
            if found is None:
                sys.exit(f"the panel did not start: {line}")
            time.sleep(2.0)
            yield found[1], process.pid
        finally:
            process.terminate()
            process.wait(30.0)


def main() -> None:
    with served() as (host, pid):
        before = Share.of(pid)
        time.sleep(SECONDS)
        server, control = Share.of(pid).since(before, SECONDS)
        value_only("panel without browser: web server", server, "%")
        value_only("panel without browser: card and control", control, "%")
        for count in BROWSERS:
            before = Share.of(pid)
            browsers = asyncio.run(_measure(f"ws://{host}/ws", count))
            server, control = Share.of(pid).since(before, SECONDS)
            ages = [age for each in browsers for age in each.ages_ms]
            answers = [age for each in browsers for age in each.answers_ms]
            name = f"panel, browsers {count}"
            at_most(f"{name}: age of positions", percentile(ages, 0.5), 20.0, "ms")
            at_most(f"{name}: age, 95 %", percentile(ages, 0.95), 60.0, "ms")
            at_most(f"{name}: answer", percentile(answers, 0.5), 5.0 * count, "ms")
            at_most(f"{name}: answer, 95 %", percentile(answers, 0.95), 20.0 * count, "ms")
            at_most(f"{name}: web server", server, 6.0 if count == 1 else 9.0, "%")
            value_only(f"{name}: card and control", control, "%")


if __name__ == "__main__":
    main()
