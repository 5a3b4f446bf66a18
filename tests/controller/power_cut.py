"""Cut the power of a card at random moments, many times, and look at what it boots with.

Run as a program: `power_cut.py FOLDER KIND CUTS SEED`. A child process saves one generation
after the other into the folder - every line, variable and setting of a generation holds its
number - and is killed with SIGKILL. Then a card is switched on with the folder; what it
finds must be one generation as a whole: the last one known to be complete or the next one.
Prints how often either was found; ends with an error at the first mixture.
"""

import os
import random
import signal
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

from openacr.controller import Controller

LINES = 30
AXES = 8
VARIABLES = 9
GENERATIONS = 2.0  # longest life of a child
MODELS = {"flash": "ACR9000", "battery": "ACR8020"}


def type_line(card: Controller, line: str) -> str:
    answer = card.send(line + "\r")
    assert answer.endswith(">"), (line, answer)
    return answer.removeprefix(line + "\r\n").rpartition("\r\n")[0]


def save(card: Controller, kind: str, number: int) -> None:
    """One generation: download, variables, parameters, and where there is no battery the flash."""
    for line in ("HALT ALL", "PROG0", "PROGRAM", *[f"P0 = {number}"] * LINES, "ENDP"):
        type_line(card, line)
    for variable in range(VARIABLES):
        type_line(card, f"P{variable} = {number}")
    for axis in range(AXES):
        type_line(card, f"AXIS{axis} PPU {number}")
    type_line(card, "ESAVE")
    type_line(card, "SYS")
    if kind == "flash":
        type_line(card, "FLASH IMAGE")
    card.advance(seconds=1.001)


def live(folder: Path, kind: str, first: int, done: int) -> None:
    """The life of the child: save until killed, and tell which generation is complete."""
    card = Controller(MODELS[kind], data=folder)
    os.write(done, b"ready\n")
    for number in range(first, first + 10_000):
        if not type_line(card, "DIM").count("DIM P("):
            type_line(card, f"DIM P({VARIABLES})")
        save(card, kind, number)
        os.write(done, b"%d\n" % number)


class Cuts:
    """Cuts the power of children; how long a generation takes it learns from them."""

    def __init__(self, folder: Path, kind: str, generation_s: float) -> None:
        self._folder, self._kind, self._generation_s = folder, kind, generation_s

    def cut(self, complete: int, generations: float) -> int:
        """Let a child save, kill it after some generations; the last generation it has completed.

        A time alone would be none or many generations where others compute, too.
        """
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                live(self._folder, self._kind, complete + 1, writer)
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(1)
        os.close(writer)
        reported = os.read(reader, 4096)
        if generations >= 1.0:
            begin_s = time.monotonic()
            reported += os.read(reader, 4096)
            self._generation_s = time.monotonic() - begin_s
        time.sleep(generations % 1.0 * self._generation_s)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        while part := os.read(reader, 4096):
            reported += part
        os.close(reader)
        assert reported.startswith(b"ready"), "the card did not start"
        *_, last = reported.split()
        return complete if last == b"ready" else int(last)


def boot(folder: Path, kind: str, complete: int) -> str:
    """Switch a card on and check what it finds; which part of it was new."""
    card = Controller(MODELS[kind], data=folder)
    assert card.nonvolatile.notices == [], card.nonvolatile.notices
    card.advance(100)
    allowed = {complete, complete + 1}
    settings = {float(type_line(card, f"AXIS{axis} PPU")) for axis in range(AXES)}
    assert len(settings) == 1, f"settings of several generations: {settings}"
    assert settings <= allowed | {1.0}, f"settings {settings}, complete was {complete}"
    lines = [line.tokens for line in card.system.programs.lines(0)]
    numbers = {int(tokens[-2].value) for tokens in lines if len(tokens) == 5}
    assert len(numbers) <= 1, f"lines of several generations: {numbers}"
    assert numbers <= allowed, f"lines of {numbers}, complete was {complete}"
    is_whole = len(lines) == LINES + 2
    if complete and not is_whole:  # only the battery sees a download half done
        assert kind == "battery", f"{len(lines)} lines"
        assert numbers <= {complete + 1}, f"{len(lines)} lines of {numbers}"
    has_any = "DIM P(" in type_line(card, "DIM")
    found = [card.p[n] for n in range(VARIABLES)] if has_any else []
    if complete:
        assert set(found) <= allowed, f"variables {found}, complete was {complete}"
        assert found == sorted(found, reverse=True), f"variables {found}"
        assert kind == "battery" or set(found) == numbers, f"variables {found} of {numbers}"
    card.close()
    is_new = complete + 1 in settings | numbers | set(found)
    return "download" if lines and not is_whole else "new" if is_new else "old"


def main(folder: Path, kind: str, cuts: int, seed: int) -> None:
    chance = random.Random(seed)
    warm = Controller(MODELS[kind])  # what the first lines make every child has from here
    type_line(warm, f"DIM P({VARIABLES})")
    begin_s = time.monotonic()
    save(warm, kind, 1)
    power = Cuts(folder, kind, time.monotonic() - begin_s)
    complete = 0
    seen: Counter[str] = Counter()
    for _ in range(cuts):
        complete = power.cut(complete, chance.uniform(0.0, GENERATIONS))
        seen[boot(folder, kind, complete)] += 1
    print(" ".join(f"{name}={count}" for name, count in sorted(seen.items())), complete)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
