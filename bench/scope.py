"""The scope: what eight channels of a card at 5 kHz cost the server of the panel."""

import asyncio
import json
import struct
import sys
import tempfile
import time
from pathlib import Path
from shutil import copy
from typing import Any

import websockets

from bench.figures import at_most, value_only
from bench.panel import HEAD, Share, served
from openacr.panel import machine

SECONDS = 20.0
PERIOD = "0.0002"  # s: 5 kHz
CHANNELS = ["P12288", "P12290", "P12291", "P12295", "P12544", "P12546", "BIT516", "P6916"]
COUNT = struct.Struct("<dQ")  # number of the first sample of a frame, count of samples


def _project(folder: str) -> str:
    """The virtual mill with a servo period of 0.2 ms."""
    text = (machine.FOLDER / "machine.toml").read_text("utf-8")
    changed = text.replace("period_s = 0.0005", f"period_s = {PERIOD}")
    if changed == text:
        sys.exit("the virtual mill has another servo period: change bench/scope.py")
    (Path(folder) / "machine.toml").write_text(changed, "utf-8")
    for each in machine.FOLDER.glob("*.toml"):
        if each.name != "machine.toml":
            copy(each, folder)
    return folder


async def _watch(url: str, *, is_on: bool) -> int:
    """Show the status, and the scope if it is on, for a time; returns the samples that came."""
    samples = 0
    async with websockets.connect(url, max_size=None) as socket:

        async def send(**data: Any) -> None:
            await socket.send(json.dumps(data))

        await send(id=1, cmd="sub", args={"topic": "status", "hz": 25})
        if is_on:
            await send(id=2, cmd="sub", args={"topic": "scope", "hz": 10})
            asked = {"channels": CHANNELS, "period_ms": 0, "sweep_ms": 1000}
            await send(id=3, cmd="scope.arm", args=asked)
        end_s = time.monotonic() + SECONDS
        while time.monotonic() < end_s:
            message = await socket.recv()
            if not isinstance(message, bytes):
                if '"ok":false' in message:
                    sys.exit(message)
                continue
            topic, _, _, seq, _, _ = HEAD.unpack_from(message)
            if topic == 4:
                samples += COUNT.unpack_from(message, HEAD.size)[1]
            await send(ack={1: "status", 4: "scope"}[topic], seq=seq)
        await send(id=4, cmd="scope.stop", args={})
    return samples


def main() -> None:
    with tempfile.TemporaryDirectory() as folder, served(_project(folder)) as (host, pid):
        shares = []
        for is_on in (False, True):
            before = Share.of(pid)
            samples = asyncio.run(_watch(f"ws://{host}/ws", is_on=is_on))
            shares.append(Share.of(pid).since(before, SECONDS))
        (server, control), (server_on, control_on) = shares
        value_only("scope of 8 at 5 kHz: samples of a channel", samples / SECONDS, "1/s")
        value_only("card and control without the scope", control, "%")
        more = server_on - server + control_on - control
        at_most("scope of 8 at 5 kHz: processor time", more, 10.0, "%")


if __name__ == "__main__":
    main()
