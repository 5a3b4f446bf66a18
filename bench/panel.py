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
from pathlib import Path
from typing import Any

import websockets

from bench.figures import at_most, percentile, value_only

SECONDS = 10.0
HEAD = struct.Struct("<BBHIdd")
BROWSERS = (1, 4)


class _Browser:
    """A browser without a picture: it acknowledges frames and now and then asks something."""

    def __init__(self, socket: Any) -> None:
        self._socket = socket
        self.ages_ms: list[float] = []
        self.answers_ms: list[float] = []
        self._asked_s = 0.0

    async def run(self, seconds: float) -> None:
        await self._send({"id": 1, "cmd": "sub", "args": {"topic": "status", "hz": 25}})
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            message = await self._socket.recv()
            if isinstance(message, bytes):
                await self._drawn(message)
            elif '"id":2,' in message and self._asked_s:
                self.answers_ms.append(1000.0 * (time.monotonic() - self._asked_s))
                self._asked_s = 0.0

    async def _drawn(self, frame: bytes) -> None:
        _, _, _, seq, _, age_ms = HEAD.unpack_from(frame)
        self.ages_ms.append(age_ms)
        await self._send({"ack": "status", "seq": seq})
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


def _cpu_s(pid: int) -> float:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        words = ["panel", "--no-browser", "--port", "0", "--store", f"{folder}/sysvar.db"]
        process = subprocess.Popen(
            [sys.executable, "-m", "openacr", *words], stdout=subprocess.PIPE, text=True
        )
        try:
            line = process.stdout.readline() if process.stdout is not None else ""
            found = re.search(r"http://(\S+)/", line)
            if found is None:
                sys.exit(f"the panel did not start: {line}")
            time.sleep(2.0)
            for count in BROWSERS:
                before_s = _cpu_s(process.pid)
                browsers = asyncio.run(_measure(f"ws://{found[1]}/ws", count))
                cpu = 100.0 * (_cpu_s(process.pid) - before_s) / SECONDS
                ages = [age for each in browsers for age in each.ages_ms]
                answers = [age for each in browsers for age in each.answers_ms]
                name = f"panel, browsers {count}"
                at_most(f"{name}: age of positions", percentile(ages, 0.5), 10.0 * count, "ms")
                at_most(f"{name}: age, 95 %", percentile(ages, 0.95), 20.0 * count, "ms")
                at_most(f"{name}: answer", percentile(answers, 0.5), 5.0 * count, "ms")
                at_most(f"{name}: answer, 95 %", percentile(answers, 0.95), 20.0 * count, "ms")
                value_only(f"{name}: processor with its card", cpu, "%")
        finally:
            process.terminate()
            process.wait(30.0)


if __name__ == "__main__":
    main()
