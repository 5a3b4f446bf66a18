"""What a card does in the same second of its life, whatever number its tick has.

Run as a module it prints what was seen from a tick on:  python -m tests.parity.long_life <tick>
"""

import sys
from collections.abc import Iterator
from itertools import pairwise

from openacr.controller import Controller
from openacr.io.pacing import Pacer
from openacr.map.rows import system

SET_UP = (
    "SYS", "HALT ALL", "NEW ALL", "DETACH ALL", "DIM P(20)", "DIM PROG1(2000)", "DIM PROG2(2000)",
    "DIM PLC0(1000)", "PLC0", "PROGRAM", "10 LD NOT 1920", "20 TIM 1 120", "30 LD TIM1",
    "40 OUT 33", "ENDP", "PROG1", "PROGRAM", "_AGAIN", "P1=P1+1", "DWL 0.03", "GOTO AGAIN", "ENDP",
    "PROG2", "PROGRAM", "INH 40 (0.11)", "P2=P6916-P9", "IHPOS P12553(30000,0.05)", "P3=P6916-P9",
    "IHPOS P12553(300,9)", "P4=P6916-P9", "INH 40", "P5=P6916-P9", "ENDP", "PROG0",
    "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"', "PPU X1000 Y1000",
    "ACC 500 DEC 500 STP 500 VEL 20", "JOG ACC Y500 : JOG DEC Y500 : JOG VEL Y2",
)  # fmt: skip
LIFE = (
    "P9=P6916", "PLC0 : RUN", "PROG1 : RUN", "PROG2 : RUN", "PROG0", "X1", "X2", 60,
    "JOG FWD Y", 100, "X0.5", 250, "JOG OFF Y", 90, "DWL 0.04 : P6=P6916-P9 : SET 40", 120,
)  # fmt: skip
BEFORE = 200  # ticks of the life before the tick it is about
SEEN = (*range(1, 7), 12288, 12544, 12297, 12553, 8199, 4097)


def card(tick: int) -> Controller:
    """A set-up card that has lived so long."""
    made = Controller()
    made.send("\r")
    for line in SET_UP:
        made.send(line + "\r")
        made.advance(4)
    made.send("DRIVE ON X Y\r")
    made.advance(200 - made.tick % 200)
    made.memory.I[system.tick_high] = tick >> 31
    made.memory.I[system.tick_low] = tick & 2**31 - 1
    return made


def live(made: Controller) -> Iterator[tuple[object, ...]]:
    """What is seen after every step, and how many ticks it took."""
    start = made.tick
    for step in LIFE:
        heard = made.send(step + "\r") if isinstance(step, str) else None
        made.advance(step if isinstance(step, int) else 2)
        lived_s = round(made.time_s - start * made.period_s, 9)
        yield heard, made.tick - start, lived_s, *(made.p[number] for number in SEEN)


def paced(made: Controller) -> list[int]:
    """Ticks of a card that follows a clock with uneven looks."""
    start, pacer, found = made.tick, Pacer(made.period_s), []
    pacer.start(0.0)
    for look in range(1, 40):
        due = pacer.due_tk(look * 0.0137)
        made.advance(due)
        pacer.advanced(due)
        found.append(made.tick - start)
    assert all(before <= after for before, after in pairwise(found))
    return found


if __name__ == "__main__":
    for seen in live(card(int(sys.argv[1]))):
        print(seen)
