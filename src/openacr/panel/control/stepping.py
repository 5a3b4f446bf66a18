"""Steps of a card through its time: to the next tick, line or move."""

from openacr.debugger.session import DebugSession
from openacr.engine.watches import Watch, Watched
from openacr.errors import UserError
from openacr.map.rows import masters
from openacr.map.words import mf1
from openacr.panel.control.history import History

LONGEST_S = 10.0  # of card time that a step may take


def step_tick(history: History) -> None:
    """Complete the present tick, or let one pass."""
    history.timeline.advance(0 if history.card.within else 1)


def step_back(history: History) -> None:
    """Go back to the end of the tick before."""
    history.timeline.seek(history.lived_tk - 1)


def step_line(history: History, program: int) -> None:
    """Go on to the next line of a program; UserError if it does not run or does not reach one."""
    debugger = DebugSession(history.card, timeline=history.timeline)
    debugger.begin_step(program, into=True)
    try:
        stop = debugger.run(_limit_tk(history))
    finally:
        history.arm()
    if stop is None:
        raise UserError(f"PROG{program} waits: it has reached no line in {LONGEST_S:g} s")


def step_move(history: History, master: int) -> None:
    """Go on until a move of a master begins or ends; UserError if none does."""
    moves = masters.head[master]
    history.card.watch(
        [
            Watch(Watched.WORD, moves),
            Watch(Watched.WORD, mf1.word[master], mf1.IN_MOTION),
        ]
    )
    try:
        has_stopped = history.timeline.advance(_limit_tk(history))
    finally:
        history.arm()
    if not has_stopped:
        raise UserError(f"no move of MASTER{master} has begun or ended in {LONGEST_S:g} s")


def _limit_tk(history: History) -> int:
    return round(LONGEST_S / history.period_s)
