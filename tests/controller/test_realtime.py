"""A card on the wall clock: the loop lives whatever Python does, and moves as on any clock."""

import ctypes
import time
from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise

import pytest
from tests.controller.hosts import at_axes

from openacr import compiled
from openacr.channels import StreamKind
from openacr.compiled import pick
from openacr.controller import Controller
from openacr.controller.realtime_card import RealtimeCard
from openacr.engine import realtime_cy as loop
from openacr.errors import UserError
from openacr.map.rows import engine as engine_rows
from openacr.map.rows import kernel, masters
from openacr.map.words import af4
from openacr.protocol.move import Move

PATH = [f"X{x} Y{y}" for x, y in ((10, 0), (10, 10), (4, 12), (0, 3), (5, 5), (5, -5), (-3, 0))]
IN_MOTION, INHIBIT = 516, 540
PATIENCE_S = 60.0
MS = 1_000_000

needs_loop = pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core")
due_after = pick(loop.realtime_due)


def machine(*program: str) -> Controller:
    """Two axes, 1000 pulses per unit, and a program that is not running yet."""
    made = at_axes().card
    for line in ("PROG0", "PROGRAM", *program, "ENDP"):
        made.ask(line + "\r")
    return made


class Live:
    """A card in real time, and a host of it."""

    def __init__(self, made: Controller, silence_s: float, most_rows: int) -> None:
        made.record(1)
        if most_rows:
            made.memory.I[engine_rows.trace_rows] = most_rows
        self.made = made
        self.card: RealtimeCard = made.real_time(silence_s)
        self.card.start()
        self.stream = self.card.open_stream(StreamKind.TERMINAL)
        self.heard = ""
        self.send("PROG0\r")

    def send(self, text: str) -> None:
        self.card.receive(self.stream, text.encode("latin-1"))

    def attend(self) -> None:
        self.card.advance()
        while data := self.card.take_output(self.stream):
            self.heard += data.decode("latin-1")

    def until(self, is_met: Callable[[], bool]) -> None:
        """Attend to the loop until something is so."""
        limit_s = time.monotonic() + PATIENCE_S
        while not is_met():
            assert time.monotonic() < limit_s, self.heard
            self.attend()
            time.sleep(0.001)

    def fill(self) -> None:
        """Let the program put its path into the buffer."""
        self.send("RUN\r")
        self.until(lambda: self.made.memory.I[masters.queued[0]] == len(PATH))
        self.until(lambda: self.card.is_settled)

    def bit(self, number: int) -> bool:
        self.card.see()
        return self.made.bit[number]

    @property
    def tick(self) -> int:
        self.card.see()
        return self.made.tick

    def cycles_and_missed(self) -> int:
        figures = self.card.figures()
        return figures.cycles + figures.missed


@contextmanager
def living(made: Controller, silence_s: float = PATIENCE_S, most_rows: int = 0) -> Iterator[Live]:
    live = Live(made, silence_s, most_rows)
    try:
        yield live
    finally:
        live.card.close()


def moving(made: Controller) -> list[tuple[float, float]]:
    """Where the two axes were commanded, tick after tick, from the first to the last motion."""
    seen = made.take_trace()
    x, y = (seen.axes[axis].commanded_u * 1000.0 for axis in (0, 1))
    places = list(zip(x.tolist(), y.tolist(), strict=True))
    changed = [n for n, (old, new) in enumerate(pairwise(places)) if old != new]
    return places[changed[0] : changed[-1] + 2] if changed else []


def inhibited(look: str) -> Controller:
    """A program with a path that begins once bit 540 is cleared."""
    made = machine(look, "MBUF ON", *PATH)
    made.bit[INHIBIT] = True
    return made


def on_virtual_clock(look: str) -> list[tuple[float, float]]:
    made = inhibited(look)
    made.send("RUN\r")
    made.advance(300)
    made.record(1)
    made.advance(1)
    made.send("CLR 540\r")
    made.advance(4000)
    return moving(made)


@needs_loop
@pytest.mark.parametrize("look", ["LOOK OFF", "LOOK ON LOOK TOL 0.2"])
def test_moves_in_the_buffer_are_to_the_count_and_tick_those_of_the_virtual_clock(
    look: str,
) -> None:
    with living(inhibited(look)) as live:
        live.fill()
        live.send("CLR 540\r")
        live.until(lambda: live.made.memory.I[masters.queued[0]] == 0 and not live.bit(IN_MOTION))
    seen = moving(live.made)
    assert seen == on_virtual_clock(look)
    assert len(seen) > 800


@needs_loop
def test_binary_moves_that_wait_for_room_are_made_in_their_order() -> None:
    packets = b"".join(
        Move.of({0: n % 5 * 500, 1: n % 3 * 500}, vel=100.0).encode() for n in range(40)
    )
    with living(at_axes().card) as live:
        stream = live.card.open_stream(StreamKind.PACKETS)
        live.card.receive(stream, packets)
        live.until(lambda: live.bit(IN_MOTION))
        live.until(lambda: not (live.card.is_wanted or live.bit(IN_MOTION)))
        assert live.made.memory.I[kernel.moves_waiting] == 0
    places = moving(live.made)
    assert places[-1] == (2000.0, 0.0)
    rises = [
        sum(old[axis] < level <= new[axis] for old, new in pairwise(places))
        for axis, level in ((0, 1250.0), (1, 250.0))
    ]
    assert rises == [8, 13]  # of 40 moves, X in cycles of five and Y in cycles of three


@needs_loop
def test_a_program_with_statements_of_python_prints_and_counts_beside_the_loop() -> None:
    made = machine("10 P1=P1+1", "PRINT P1", "DWL 0.002", "IF (P1<20) THEN GOTO 10")
    made.ask("SYS\rDIM P(9)\rPROG0\r")
    with living(made) as live:
        live.send("LRUN\r")
        live.until(lambda: live.heard.rstrip().endswith("P00>") and "20" in live.heard)
    numbers = [int(line) for line in live.heard.split("\r\n") if line.strip().isdigit()]
    assert numbers == list(range(1, 21))
    assert made.p[1] == 20


@needs_loop
def test_python_that_holds_its_lock_makes_no_tick_late_and_changes_no_setpoint() -> None:
    held = ctypes.PyDLL(None).usleep  # does not give the lock away
    with living(inhibited("LOOK OFF")) as live:
        live.fill()
        live.send("CLR 540\r")
        live.until(lambda: live.bit(IN_MOTION))
        before = live.cycles_and_missed()
        held(500_000)
        live.until(lambda: live.cycles_and_missed() >= before + 500)
        live.until(lambda: not live.bit(IN_MOTION))
    assert moving(live.made) == on_virtual_clock("LOOK OFF")


@needs_loop
def test_without_a_beat_programs_stop_and_moves_in_the_buffer_run_to_their_end() -> None:
    made = machine("MBUF ON", "X20", "20 P1=P1+1", "DWL 0.001", "GOTO 20")
    made.ask("SYS\rDIM P(9)\rPROG0\r")
    with living(made, silence_s=0.2) as live:
        live.send("RUN\r")
        live.until(lambda: live.bit(IN_MOTION))
        live.until(lambda: live.tick > 1 and live.made.p[1] > 2)
        limit_s = time.monotonic() + PATIENCE_S
        while live.bit(IN_MOTION):  # `bit` looks, but gives no beat
            assert time.monotonic() < limit_s
            time.sleep(0.01)
        counted, at_tk = made.p[1], live.tick
        while live.tick < at_tk + 100:
            assert time.monotonic() < limit_s
            time.sleep(0.01)
        assert made.p[1] == counted
        live.until(lambda: live.tick > 0 and live.made.p[1] > counted + 2)
    assert moving(made)[-1] == (20_000.0, 0.0)


@needs_loop
def test_the_end_of_python_brings_a_moving_axis_to_rest_by_its_ramp() -> None:
    made = machine()
    with living(made) as live:
        live.send("HLDEC X1000\rX100\r")
        live.until(lambda: live.bit(IN_MOTION) and made.axis(0).velocity_ups > 50.0)
    assert not made.bit[IN_MOTION]
    x = [place for place, _ in moving(made)]
    assert 0.0 < x[-1] < 100_000.0
    steps = [new - old for old, new in pairwise(x)]
    assert max(abs(b - a) for a, b in pairwise(steps)) < 1.0


@needs_loop
def test_a_loop_that_hears_nothing_for_long_ends_at_rest_and_says_so() -> None:
    made = machine()
    with living(made, silence_s=0.02) as live:
        live.send("JOG FWD X\r")
        limit_s = time.monotonic() + PATIENCE_S
        while live.card.is_alive:
            assert time.monotonic() < limit_s
            time.sleep(0.01)
        with pytest.raises(UserError, match="heard nothing of Python for too long"):
            live.card.advance()
    made.advance(1)
    assert made.axis(0).velocity_ups == 0.0


@needs_loop
def test_reboot_makes_another_card_of_it_while_it_lives() -> None:
    made = machine("PRINT 1")
    with living(made) as live:
        live.send("P0=1\rREBOOT\r")
        live.until(lambda: live.made.clock.before_tk > 0)
        before = live.tick
        live.until(lambda: live.tick > before + 20)
        assert live.tick < 100_000
    assert not made.memory.I[af4.word[0]] & af4.DRIVE_ENABLED


@needs_loop
def test_kinematics_that_need_python_are_killed_and_it_is_said(
    caplog: pytest.LogCaptureFixture,
) -> None:
    made = machine()
    made.ask("PROG1\rPROGRAM\rPRINT 1\rENDP\rPROG0\rINVK PROG1\rINVK ON\r")
    with living(made) as live:
        live.send("X10\r")
        live.until(lambda: "INVK of master 0 needs Python within a tick" in caplog.text)
        live.until(lambda: not live.bit(IN_MOTION))
    assert made.memory.I[kernel.kinematics] == 0
    assert "1" not in live.heard.replace("X10", "")


@needs_loop
def test_what_a_loop_on_the_wall_clock_cannot_do_is_refused() -> None:
    made = machine()
    made.announce_lines(1, lambda program, line: False)
    with pytest.raises(UserError, match="stops before no line"):
        made.real_time()
    made.announce_lines()
    with pytest.raises(UserError, match="a silence of 0 s: it has to be above 0"):
        made.real_time(0.0)
    made.ask("PERIOD 0.0001\r")
    with pytest.raises(UserError, match=r"a servo period of 100 us: .* 200 us and more"):
        made.real_time()
    made.ask("PERIOD 0.001\r")
    with living(made), pytest.raises(UserError, match="cannot be advanced by hand"):
        made.advance(1)
    made.advance(1)


@needs_loop
def test_a_recording_that_is_full_ends_and_ticks_go_on(caplog: pytest.LogCaptureFixture) -> None:
    with living(machine(), most_rows=50) as live:
        live.until(lambda: "the recording is full and has ended" in caplog.text)
        live.until(lambda: live.tick > 200)
    assert len(live.made.take_trace().time_s) == 50


@pytest.mark.skipif(compiled.is_compiled, reason="of plain Python")
def test_plain_python_has_no_loop_on_the_wall_clock() -> None:
    with pytest.raises(UserError, match="needs the compiled core"):
        machine().real_time()


def numbers(*, is_made_up: bool = True) -> "memoryview[float]":
    made = array("d", [0.0] * loop.N_ROWS)
    made[loop.MADE_UP] = float(is_made_up)
    return memoryview(made)


def test_a_tick_that_is_late_within_its_period_moves_no_other() -> None:
    kept = numbers()
    assert due_after(kept, 10 * MS, MS, 11 * MS) == 11 * MS
    assert due_after(kept, 10 * MS, MS, 12 * MS - 1) == 11 * MS
    assert (kept[loop.MISSED], kept[loop.OWED_NS], kept[loop.LOST_NS]) == (0.0, 0.0, 0.0)


def test_missed_periods_are_made_up_by_shorter_ones_none_at_once() -> None:
    kept = numbers()
    due = due_after(kept, 10 * MS, MS, 13 * MS)  # periods 11 and 12 are over
    assert kept[loop.MISSED] == 2.0
    dues = [due]
    while kept[loop.OWED_NS]:
        dues.append(due_after(kept, dues[-1], MS, dues[-1]))
    assert dues[0] == 13 * MS - MS // 32
    assert {new - old for old, new in pairwise(dues)} == {MS - MS // 32}
    assert len(dues) == 64
    assert dues[-1] == 13 * MS + 63 * MS - 2 * MS  # on the grid as if none had been missed
    assert due_after(kept, dues[-1], MS, dues[-1]) == dues[-1] + MS
    assert kept[loop.LOST_NS] == 0.0


def test_a_period_is_missed_once_it_is_over() -> None:
    kept = numbers()
    assert due_after(kept, 10 * MS, MS, 12 * MS) == 12 * MS - MS // 32
    assert kept[loop.MISSED] == 1.0


def test_no_more_time_is_made_up_than_was_missed() -> None:
    period, kept = 1_000_001, numbers()
    due = due_after(kept, 0, period, 3 * period)
    for _ in range(70):
        due = due_after(kept, due, period, due)
    assert due == (3 + 70) * period - 2 * period


def test_time_that_cannot_be_made_up_is_lost_and_counted() -> None:
    kept = numbers()
    assert due_after(kept, 0, MS, 300 * MS) == 300 * MS
    assert (kept[loop.MISSED], kept[loop.LOST_NS], kept[loop.OWED_NS]) == (299.0, 299.0 * MS, 0.0)
    at_once = numbers(is_made_up=False)
    assert due_after(at_once, 0, MS, 5 * MS) == 5 * MS
    assert (at_once[loop.MISSED], at_once[loop.LOST_NS]) == (4.0, 4.0 * MS)
