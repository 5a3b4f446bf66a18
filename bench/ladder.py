"""The live ladder: what eight full PLCs, drawn at 10 Hz by eight browsers, cost the panel."""

import asyncio
import json
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from shutil import copy

import websockets

from bench.figures import at_least, at_most, value_only
from bench.panel import HEAD, Share, served
from openacr.map.numbers import FLAG_WORD_BASE
from openacr.panel import machine
from openacr.panel.wire.frames import Topic

SECONDS = 8.0
TURNS = 3  # without and with ladders by turns: other work on the machine disturbs both
PLCS, INSTRUCTIONS, RATE_HZ = 8, 192, 10
BITS, OUTPUTS, CONTACTS = 13, 10, 7  # of the counter of a PLC, and what is made of it
RUNNING, EACH = 1536, 32  # flag "PLC Running" of PLC 0, flags of a PLC


def _rungs(plc: int) -> Iterator[str]:
    """A binary counter of the scans and outputs made of its bits: every frame is another one."""
    bits = [1920 + 16 * plc + bit for bit in range(BITS)]  # user flags
    carries = (bits[-1] + 1, bits[-1] + 2)
    first = 300 + 64 * (plc // 2) + OUTPUTS * (plc % 2)  # outputs of expansion boards
    yield f"LD {bits[0]}:OUT {carries[0]}"
    yield f"LD NOT {bits[0]}:OUT {bits[0]}"
    for place, bit in enumerate(bits[1:]):
        carry, next_carry = carries[place % 2], carries[1 - place % 2]
        yield f"LD {carry}:AND {bit}:OUT {next_carry}"
        yield f"LD {carry}:AND NOT {bit}:LD NOT {carry}:AND {bit}:OR LD:OUT {bit}"
    for output in range(OUTPUTS):
        chosen = [bits[(output + place) % BITS] for place in range(CONTACTS)]
        contacts = ":OR NOT ".join(map(str, chosen))
        yield f"LD {contacts}:OUT {first + output}"


def _text(plc: int) -> str:
    """A PLC that runs from power-up, an instruction in each line."""
    words = [word for rung in _rungs(plc) for word in rung.split(":")]
    if len(words) != INSTRUCTIONS:
        sys.exit(f"PLC{plc} has {len(words)} instructions instead of {INSTRUCTIONS}")
    lines = ["PBOOT", *words]
    return f"PLC{plc}\n" + "".join(f"{10 * n} {line}\n" for n, line in enumerate(lines, 1))


def _project(folder: Path) -> str:
    """The virtual mill with eight PLCs."""
    for each in machine.FOLDER.glob("*.toml"):
        copy(each, folder)
    dims = "".join(f"DIM PLC{plc}({8 * (INSTRUCTIONS + 8)})\n" for plc in range(PLCS))
    (folder / "setup.8k").write_text(f"SYS\nHALT ALL\nNEW ALL\nCLEAR\n{dims}")
    for plc in range(PLCS):
        (folder / f"plc{plc}.8k").write_text(_text(plc))
    return str(folder)


def _words(host: str, plc: int) -> set[int]:
    """The words of flags that the ladder of a PLC shows, which must be drawn and run."""
    with urllib.request.urlopen(f"http://{host}/api/card/ladder?plc={plc}") as answer:
        found = json.load(answer)
    if not found["rungs"]:
        sys.exit(f"PLC{plc} is not drawn: {found['why'] or 'it is empty'}")
    symbols = [symbol for rung in found["rungs"] for symbol in rung["symbols"]]
    flags = [symbol["flag"] for symbol in symbols if symbol["flag"] is not None]
    return {FLAG_WORD_BASE + flag // 32 for flag in [RUNNING + EACH * plc, *flags]}


async def _browser(host: str, words: list[int]) -> int:
    """Draw these words for some seconds (none: no ladder); how many frames came."""
    frames = 0
    async with websockets.connect(f"ws://{host}/ws") as socket:
        if words:
            args = {"topic": "flags", "hz": RATE_HZ, "words": words}
            await socket.send(json.dumps({"id": 1, "cmd": "sub", "args": args}))
        end_s = time.monotonic() + SECONDS
        while (left_s := end_s - time.monotonic()) > 0.0:
            try:
                async with asyncio.timeout(left_s):
                    message = await socket.recv()
            except TimeoutError:
                break
            if isinstance(message, bytes):
                topic, _, _, seq, _, _ = HEAD.unpack_from(message)
                frames += topic == Topic.FLAGS
                await socket.send(json.dumps({"ack": "flags", "seq": seq}))
            elif '"ok":false' in message:
                sys.exit(message)
    return frames


async def _watch(host: str, words: list[int]) -> int:
    """Eight browsers, each with all eight ladders or with none; the frames of all."""
    return sum(await asyncio.gather(*(_browser(host, words) for _ in range(PLCS))))


def main() -> None:
    with (
        tempfile.TemporaryDirectory() as folder,
        served(_project(Path(folder))) as (host, pid),
    ):
        words = sorted(set().union(*(_words(host, plc) for plc in range(PLCS))))
        used: dict[bool, list[tuple[float, float]]] = {False: [], True: []}
        frames = 0
        for _ in range(TURNS):
            for is_on, each in used.items():
                before = Share.of(pid)
                frames += asyncio.run(_watch(host, words if is_on else []))
                each.append(Share.of(pid).since(before, SECONDS))
    control = min(each[1] for each in used[False])
    more = min(map(sum, used[True])) - min(map(sum, used[False]))
    name = f"ladders of {PLCS} PLCs, browsers {PLCS}"
    rate_hz = frames / (TURNS * SECONDS * PLCS)
    at_least(f"{name}: frames of each", rate_hz, 0.9 * RATE_HZ, "1/s")
    value_only(f"{name}: card and control without", control, "%")
    at_most(f"{name}: processor time", more, 5.0, "%")


if __name__ == "__main__":
    main()
