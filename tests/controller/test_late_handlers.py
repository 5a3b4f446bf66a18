"""Handlers that take time while ticks go on: nothing of either side is lost, no axis jumps."""

from collections.abc import Sequence
from itertools import pairwise
from random import Random

import pytest
from tests.controller.hosts import at_axes
from tests.controller.late_life import digests
from tests.parity.journeys import JOURNEYS, card, live, take
from tests.parity.plain import printed_by_plain_python

from openacr import compiled
from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.controller.late_handlers import LateHandlers, _Pending
from openacr.errors import UserError
from openacr.kernel import calls_cy
from openacr.map.rows import masters
from openacr.map.words import pf
from openacr.protocol.move import Move

IN_MOTION, KILL, INHIBIT = 516, 522, 540
PATH = [f"X{x} Y{y}" for x, y in ((10, 0), (10, 10), (4, 12), (0, 3), (5, 5), (5, -5), (-3, 0))]
LATE_TK = 50
WAITING = pf.PROGRAM_DWELLING | pf.PROGRAM_INHIBITED | pf.MOVE_PENDING


def machine(*program: str, number: int = 0) -> Controller:
    """Two axes, 1000 pulses per unit, and a program that is not running yet."""
    made = at_axes().card
    enter(made, number, *program)
    return made


def enter(made: Controller, number: int, *program: str) -> None:
    made.ask(f"PROG{number}\r")
    for line in ("PROGRAM", *program, "ENDP"):
        made.ask(line + "\r")
    made.ask("PROG0\r")


def setpoints(made: Controller, ticks: int) -> list[tuple[float, float]]:
    """Where the two axes are commanded, tick after tick [pulses]."""
    made.record(1)
    made.advance(ticks)
    seen = made.take_trace()
    x, y = (seen.axes[axis].commanded_u * 1000.0 for axis in (0, 1))
    return list(zip(x.tolist(), y.tolist(), strict=True))


def from_first_motion(places: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Without the rest at the beginning and at the end."""
    moving = [n for n, (old, new) in enumerate(pairwise(places)) if old != new]
    return list(places[moving[0] : moving[-1] + 2]) if moving else []


def largest_jerk_cnt(places: Sequence[tuple[float, float]]) -> float:
    """The largest change of velocity between two ticks, in pulses per tick."""
    found = 0.0
    for axis in (0, 1):
        steps = [new[axis] - old[axis] for old, new in pairwise(places)]
        found = max(found, *(abs(b - a) for a, b in pairwise(steps)))
    return found


@pytest.mark.parametrize("name", JOURNEYS)
def test_handlers_that_take_no_time_change_nothing(name: str) -> None:
    made = card()
    made.delay_handlers(0)
    found = []
    for step in JOURNEYS[name]:
        take(made, step)
        found.append(made.digest())
    assert found == list(live(name))


@pytest.mark.parametrize("look", ["LOOK OFF", "LOOK ON", "LOOK ON LOOK TOL 0.2"])
@pytest.mark.parametrize("seed", range(4))
def test_a_path_in_the_buffer_runs_to_the_count_and_tick(look: str, seed: int) -> None:
    """The program fills the buffer late; what is in it runs as if it had been there at once."""

    def run(longest_tk: int | None) -> list[tuple[float, float]]:
        made = machine(look, "MBUF ON", *PATH)
        made.bit[INHIBIT] = True
        made.delay_handlers(longest_tk, seed=seed)
        made.send("RUN\r")
        places = setpoints(made, 1200)
        made.bit[INHIBIT] = False
        return from_first_motion(places + setpoints(made, 3000))

    late = run(LATE_TK)
    assert len(late) > 800
    assert late == run(None)


@pytest.mark.parametrize("seed", range(4))
def test_a_program_that_refills_the_buffer_late_moves_as_ever(seed: int) -> None:
    moves = [f"X{n % 5 * 2} Y{n % 3 * 2}" for n in range(30)]

    def run(longest_tk: int | None) -> list[tuple[float, float]]:
        made = machine("MBUF ON", *moves)
        made.delay_handlers(longest_tk, seed=seed)
        made.send("RUN\r")
        return from_first_motion(setpoints(made, 9000))

    assert run(20) == run(None)


@pytest.mark.parametrize("seed", range(4))
def test_binary_moves_that_wait_for_room_run_as_ever(seed: int) -> None:
    """More than the buffer holds arrive at once; the loop asks for the next ones, once for each."""
    packets = [Move.of({0: n % 5 * 2000, 1: n % 3 * 2000}, vel=100.0).encode() for n in range(40)]

    def run(longest_tk: int | None) -> list[tuple[float, float]]:
        made = at_axes().card
        made.delay_handlers(longest_tk, seed=seed)
        stream = made.open_stream(StreamKind.PACKETS)
        places = setpoints(made, 1)
        made.receive(stream, b"".join(packets))
        return from_first_motion(places + setpoints(made, 14000))

    late = run(20)
    assert late[-1] == (8000.0, 0.0)
    assert late == run(None)


@pytest.mark.parametrize("seed", range(4))
def test_no_flag_of_either_side_is_lost(seed: int) -> None:
    """A program in the loop and a host set flags of one word, each at its own times."""
    program = [line for n in range(15) for line in ("DWL 0.012", f"SET {1921 + 2 * n}", "P1=P1+1")]
    made = machine(*program)
    made.ask("SYS\rDIM P(100)\r")
    made.delay_handlers(LATE_TK, seed=seed)
    made.send("RUN PROG0\r")
    for n in range(15):
        made.send(f"SET {1920 + 2 * n}\rP{10 + n}={n}\r")
        made.advance(23)
    made.advance(600)
    assert [n for n in range(1920, 1952) if made.bit[n]] == list(range(1920, 1950))
    assert made.p[1] == 15
    assert [made.p[10 + n] for n in range(15)] == list(range(15))


@pytest.mark.parametrize(("seed", "after_tk"), [(n, 37 * n % 400) for n in range(12)])
def test_a_move_that_is_issued_while_a_kill_comes_is_killed(seed: int, after_tk: int) -> None:
    made = machine("MBUF ON", *PATH)
    made.delay_handlers(LATE_TK, seed=seed)
    made.send("RUN\r")
    made.advance(after_tk)
    made.until(IN_MOTION, ticks=400)
    made.send("SET 522\r")
    made.advance(200)
    assert made.bit[KILL]
    assert not made.bit[IN_MOTION]
    here = setpoints(made, 1)[0]
    made.send("HALT\rCLR 522\r")
    assert set(setpoints(made, 800)) == {here}


def test_a_move_whose_predecessors_are_dropped_is_dropped_with_them() -> None:
    made = machine()
    made.ask("MBUF ON\rX10\rX20\rX30\r")
    rows = made.memory.I
    record = rows[masters.first[0]] + rows[masters.head[0]] + rows[masters.queued[0]]
    made.bit[KILL] = True
    made.advance(2)
    made.bit[KILL] = False
    made.card.call(calls_cy.RECORD_ENTER, 0, record)
    assert not rows[masters.queued[0]]
    assert not made.bit[IN_MOTION]
    made.card.call(calls_cy.RECORD_ENTER, 0, rows[masters.first[0]] + rows[masters.head[0]])
    assert rows[masters.queued[0]] == 1


COMMANDS = (
    *PATH, "JOG FWD X", "JOG OFF X", "JOG INC X1", "JOG ABS Y2", "JOG REV Y", "JOG OFF Y",
    "SET 520", "SET 521", "HALT", "FOV 0.5", "FOV 1", "VEL 40", "VEL 100", "JOG RES X",
    "JOG REN Y", "PAUSE", "RESUME",
)  # fmt: skip

OTHERS = (
    "TRJ X3 Y1", "TRJ X-3", "MSEEK X(2,0)", "GEAR SRC X1", "GEAR ON X", "GEAR OFF X", "GEAR RES X",
    "CAM OFF X", "RES X", "REN Y", "INTCAP X2", "ENC0 RES 5", "ENC1 LIMIT 4000", "JOG HOME X1",
    "DRIVE OFF X", "DRIVE ON X", "LOOK ON LOOK TOL 0.2", "LOOK OFF", "SET 522", "HALT CLR 522",
    "RUN PROG1", "HALT PROG1", "HALT ALL", "SPLINE MODE 0", "SPLINE END", "BKL X0.1", "SET 8467",
    "CLR 8467", "ROTATE 10 X0 Y0", "DWL 0.02", "P1=7", "LIST", "MULT X4", "PGAIN X0.002", "TOV 1",
)  # fmt: skip


@pytest.mark.parametrize("seed", range(12))
def test_no_setpoint_jumps_whatever_is_commanded_while_it_moves(seed: int) -> None:
    """Each command acts on the path and the jog as they are when it is taken over."""
    drawn = Random(seed)
    made = machine()
    made.ask("MBUF ON\r")
    made.delay_handlers(LATE_TK, seed=seed)
    places = setpoints(made, 1)
    for _ in range(40):
        made.send(drawn.choice(COMMANDS) + "\r")
        places += setpoints(made, drawn.randrange(90))
    # 1000 and 500 units/s2 are 0.25 and 0.125 pulses per tick2; a corner may add as much again.
    assert largest_jerk_cnt(places) < 1.0


HALTED = ("10 P1=P1+1", "PRINT P1", "DWL 0.003", "PRINT P1+0.5", "GOTO 10")


@pytest.mark.parametrize("seed", range(8))
def test_a_program_that_is_halted_and_run_anew_while_its_statement_waits(seed: int) -> None:
    """What the loop made of the program before it learned of that is nothing any more."""
    drawn = Random(seed)
    made = machine()
    made.ask("SYS\rDIM P(9)\rPROG0\r")
    enter(made, 1, *HALTED)
    made.delay_handlers(LATE_TK, seed=seed)
    heard: list[str] = []
    made.listen(lambda program, text: heard.append(text))
    for _ in range(30):
        made.send(drawn.choice(("RUN PROG1", "HALT PROG1", "HALT PROG1 RUN PROG1")) + "\r")
        made.advance(drawn.randrange(70))
    made.send("HALT PROG1\r")
    made.advance(2 * LATE_TK)
    count, printed = made.p[1], len(heard)
    made.advance(200)
    assert (made.p[1], len(heard)) == (count, printed)
    assert not any(made.memory.I[pf.word[1]] & mask for mask in (pf.PROGRAM_RUNNING, WAITING))
    made.send("P1=0\rRUN PROG1\r")
    del heard[:]
    made.advance(3000)
    numbers = [float(text) for text in heard if text.strip()]
    assert numbers[:4] == [1.0, 1.5, 2.0, 2.5]


@pytest.mark.parametrize("seed", range(6))
def test_rows_that_both_sides_change_have_a_rule(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No cell becomes the handler's that the loop has changed since the handler began."""
    crossed: set[int] = set()
    take_over = LateHandlers._take

    def taken(self: LateHandlers, pending: _Pending) -> None:
        crossed.update(place for _, place in pending.changes.crossed(self.machine))
        take_over(self, pending)

    monkeypatch.setattr(LateHandlers, "_take", taken)
    drawn = Random(seed)
    made = machine()
    made.ask("SYS\rDIM P(9)\rPROG0\rMBUF ON\r")
    enter(made, 1, *HALTED)
    made.delay_handlers(LATE_TK, seed=seed)
    for _ in range(60):
        made.send(drawn.choice(COMMANDS + OTHERS) + "\r")
        made.advance(drawn.randrange(60))
    assert not crossed


@pytest.mark.skipif(not compiled.is_compiled, reason="needs both builds")
def test_both_builds_live_the_same_late_life() -> None:
    assert printed_by_plain_python("tests.controller.late_life") == digests()


def test_an_equal_seed_gives_an_equal_life_and_another_one_another() -> None:
    def life(seed: int) -> str:
        made = machine("MBUF ON", *PATH, 'PRINT "done"')
        made.delay_handlers(LATE_TK, seed=seed)
        made.send("RUN\r")
        made.advance(300)
        return made.digest()

    assert life(1) == life(1)
    assert life(1) != life(2)


def test_pending_work_is_part_of_a_snapshot_and_of_the_card_without_delays() -> None:
    made = machine("MBUF ON", *PATH)
    made.delay_handlers(10_000)
    made.send("RUN\r")
    made.advance(40)
    snapshot = made.snapshot()
    made.delay_handlers(None)
    made.advance(3000)
    ended = made.digest()
    made.restore(snapshot)
    made.delay_handlers(None)
    made.advance(3000)
    assert made.digest() == ended
    assert not made.bit[IN_MOTION]
    assert setpoints(made, 1) == [(-3000.0, 0.0)]


@pytest.mark.parametrize("seed", range(6))
def test_a_caller_waits_for_the_end_of_a_move_that_is_still_to_begin(seed: int) -> None:
    made = machine()
    made.delay_handlers(LATE_TK, seed=seed)
    made.send("X2\r")
    assert made.until(IN_MOTION, False)
    assert setpoints(made, 1) == [(2000.0, 0.0)]


def test_a_negative_time_is_refused() -> None:
    with pytest.raises(UserError, match="handlers that take -1 ticks: the minimum is 0"):
        Controller().delay_handlers(-1)
