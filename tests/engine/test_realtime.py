"""Steps of the real-time loop, one by one, without a clock: lists, silence, the end."""

from array import array
from itertools import pairwise

import pytest
from tests.controller.hosts import at_axes

from openacr.basic.vm.scheduler_cy import THREAD_AWAY
from openacr.compiled import pick
from openacr.controller import Controller
from openacr.engine import change_log_cy
from openacr.engine import realtime_cy as loop
from openacr.engine.changes_cy import ENTRY
from openacr.fieldbus.machine import exchange_cy
from openacr.fieldbus.machine.exchange_memory import ExchangeMemory
from openacr.map.numbers import HEAP_BYTE_BASE
from openacr.map.rows import axes, kernel, masters, scheduler, threads
from openacr.map.words import af4, mf1
from openacr.views import F64, I32

WORD = 0  # kind of an entry

_step = pick(loop.realtime_step)
_give = pick(loop.realtime_give)


def ints(count: int) -> I32:
    return memoryview(array("i", [0] * count))


def reals(count: int) -> F64:
    return memoryview(array("d", [0.0] * count))


class Stepped:
    """The loop on the memory of a card; each `step` is a period."""

    def __init__(self, made: Controller, silence_tk: float = 1e9) -> None:
        self.made, self.memory = made, made.memory
        self.rows, self.numbers = ints(loop.H_ROWS), reals(loop.N_ROWS)
        self.numbers[loop.SILENCE_S] = (silence_tk + 0.5) * made.period_s
        self.numbers[loop.GONE_S] = (10 * silence_tk + 0.5) * made.period_s
        self.entries = ints(ENTRY * 100)
        self.spare = Controller().memory
        self.seen, self.log = ints(HEAP_BYTE_BASE // 4), ints(change_log_cy.HEAD)
        self.bus = ExchangeMemory()
        space = made.executor.threads.space
        self.code = space.code, space.nums
        self.other_code = self.code

    def step(self, count: int = 1) -> None:
        m, bus = self.memory, self.bus
        for _ in range(count):
            _step(
                m.F, m.I, m.S, *self.code, *self.other_code, reals(8), self.seen, self.log,
                self.entries, self.entries.cast("B").cast("d"), self.spare.I, self.rows,
                self.numbers, bus.rows, bus.numbers, bus.out, bus.back,
            )  # fmt: skip

    def give(self, first: int, count: int, code: int = 0) -> None:
        k = loop.LISTS + loop.LIST_ROWS * (self.rows[loop.GIVEN] % loop.QUEUE)
        self.rows[k], self.rows[k + 1], self.rows[k + 2] = first, count, code
        _give(self.rows)

    def beat(self) -> None:
        self.rows[loop.BEAT] += 1

    @property
    def tick(self) -> int:
        return self.made.tick


def running(*program: str) -> Controller:
    """A card whose program 0 has begun."""
    made = at_axes().card
    for line in ("SYS", "DIM P(9)", "PROG0", "PROGRAM", *program, "ENDP", "RUN"):
        made.ask(line + "\r")
    return made


def test_a_step_is_a_tick_and_leaves_the_sequence_even() -> None:
    live = Stepped(at_axes().card)
    before = live.tick
    for n in range(1, 5):
        live.step()
        assert (live.tick, live.rows[loop.SEQUENCE]) == (before + n, 2 * n)
    assert live.numbers[loop.CYCLES] == 4.0


def test_figures_begin_at_0_once_when_python_asks_and_settings_stay() -> None:
    live = Stepped(at_axes().card, silence_tk=100)
    n, bus = live.numbers, live.bus.numbers
    live.step(3)
    figures = (loop.LOST_NS, loop.MISSED, loop.WORST_WAKE_NS, loop.WORST_WORK_NS)
    bins = (loop.WAKE, loop.WAKE + loop.BINS - 1, loop.WORK, loop.WORK + loop.BINS - 1)
    for row in (*figures, loop.WORST_TAKE_NS, *bins):
        n[row] = 5.0
    bus[exchange_cy.SENT_FRAMES] = 6.0
    silence_s, n[loop.OWED_NS], n[loop.MADE_UP] = n[loop.SILENCE_S], 3.0, 1.0
    live.rows[loop.FROM_ZERO] += 1
    live.step()
    assert [n[row] for row in (*figures, loop.WORST_TAKE_NS, *bins)] == [0.0] * 9
    assert (n[loop.CYCLES], bus[exchange_cy.SENT_FRAMES]) == (1.0, 0.0)
    assert (n[loop.SILENCE_S], n[loop.OWED_NS], n[loop.MADE_UP]) == (silence_s, 3.0, 1.0)
    live.step()
    assert n[loop.CYCLES] == 2.0


def test_one_list_is_taken_over_a_period_in_their_order_also_around_the_end_of_the_queue() -> None:
    live = Stepped(at_axes().card)
    place = threads.line[15]  # of a program that never runs
    for n in range(100):
        live.entries[ENTRY * n : ENTRY * (n + 1)] = array("i", [WORD, place, n, 0, n + 1, 0])
    for n in range(40):
        live.give(n, 1)
    for n in range(40):
        assert live.rows[loop.TAKEN] == n
        live.step()
        assert live.memory.I[place] == n + 1
    live.step()
    assert live.rows[loop.TAKEN] == 40
    for n in range(40, 100):
        live.give(n, 1)
    live.step(60)
    assert (live.rows[loop.TAKEN], live.memory.I[place]) == (100, 100)


def test_a_list_brings_the_programs_that_are_valid_with_it() -> None:
    made = running("10 P1=P1+1", "GOTO 10")
    live = Stepped(made)
    live.step(20)
    live.other_code = memoryview(array("i", made.executor.threads.space.code)), live.code[1]
    live.code = memoryview(array("i", [0] * len(live.other_code[0]))), live.code[1]
    live.give(0, 0, code=2)
    before = made.p[1]
    live.step(20)
    assert made.p[1] > before
    assert live.rows[loop.CODE] == 1
    live.give(0, 0)  # a list without programs
    live.step()
    assert live.rows[loop.CODE] == 1


def test_the_whole_state_can_be_replaced() -> None:
    live = Stepped(at_axes().card)
    live.spare.I[threads.line[15]] = 77
    live.give(0, loop.WHOLE)
    live.step()
    assert live.memory.I[threads.line[15]] == 77
    assert live.tick == 1


def test_programs_pause_after_the_silence_and_continue_with_a_beat() -> None:
    made = running("10 P1=P1+1", "GOTO 10")
    live = Stepped(made, silence_tk=10)
    live.beat()
    live.step(11)  # the first hears the beat
    assert live.rows[loop.IS_SILENT] == 0
    programs = made.memory.I[scheduler.programs]
    live.step()
    assert live.rows[loop.IS_SILENT] == 1
    counted = made.p[1]
    live.step(20)
    assert made.p[1] == counted > 0
    assert made.memory.I[scheduler.programs] == programs == 1
    live.beat()
    live.step(8)
    assert live.rows[loop.IS_SILENT] == 0
    assert made.p[1] > counted


def test_after_ten_times_the_silence_motion_is_killed_and_the_loop_ends_at_rest() -> None:
    made = at_axes().card
    made.send("PROG0\rHLDEC X1000 Y1000\rJOG FWD X\r")
    live = Stepped(made, silence_tk=20)
    live.step(200)
    assert live.rows[loop.STATE] == loop.RUNNING
    live.step()
    assert live.rows[loop.STATE] == loop.ENDING
    for n in range(2):
        assert made.memory.I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST
    assert made.memory.I[mf1.word[0]] & mf1.KILL_ALL_MOVES_REQUEST
    speeds = []
    for _ in range(2000):
        speeds.append(made.memory.F[axes.psp_velocity_cps[0]])
        if live.rows[loop.STATE] == loop.ENDED:
            break
        live.step()
    assert live.rows[loop.STATE] == loop.ENDED
    assert speeds[0] > 0.0
    assert speeds[-loop.REST_TK :] == [0.0] * loop.REST_TK
    assert speeds[-loop.REST_TK - 1] > 0.0
    steps = [old - new for old, new in pairwise(speeds)]
    assert max(steps) < 1000 * 1000 * made.period_s * 1.01  # HLDEC


@pytest.mark.parametrize("is_asked", [False, True])
def test_the_end_is_asked_for(is_asked: bool) -> None:
    live = Stepped(at_axes().card)
    live.step(3)
    live.rows[loop.END] = int(is_asked)
    live.step(loop.REST_TK)
    assert (live.rows[loop.STATE] == loop.ENDED) == is_asked


def test_a_thread_that_needs_python_waits_for_it_and_another_goes_on() -> None:
    made = running("10 P1=P1+1", "PRINT P1", "P3=1")
    for line in ("PROG1", "PROGRAM", "10 P2=P2+1", "GOTO 10", "ENDP", "RUN"):
        made.ask(line + "\r")
    made.ask("RUN PROG0\r")
    made.p[3] = 0
    live = Stepped(made)
    live.step(100)
    assert made.memory.I[threads.state[0]] == THREAD_AWAY
    before = made.p[2]
    live.step(50)
    assert made.memory.I[threads.state[0]] == THREAD_AWAY
    assert made.p[3] == 0
    assert made.p[2] > before


def test_room_is_asked_for_once_a_tick_and_not_forgotten() -> None:
    made = at_axes().card
    made.memory.I[kernel.moves_waiting] = 1
    made.memory.I[masters.room_below[0]] = 1
    live = Stepped(made)
    asked = []
    for _ in range(3):
        live.step()
        asked.append(live.rows[loop.ASKED_ROOM])
        assert made.memory.I[kernel.moves_waiting] == 1
    assert asked == [1, 2, 3]


def test_programs_get_no_slices_while_the_loop_ends() -> None:
    made = running("10 P1=P1+1", "GOTO 10")
    live = Stepped(made)
    live.step(20)
    counted = made.p[1]
    live.rows[loop.END] = 1
    live.step(2)  # in the first the end is heard
    heard = made.p[1]
    live.step(10)
    assert made.p[1] == heard
    assert heard - counted < 20


def test_joints_that_need_python_are_left_and_their_path_is_killed() -> None:
    made = at_axes().card
    made.ask("PROG1\rPROGRAM\rPRINT 1\rENDP\rPROG0\rINVK PROG1\rINVK ON\r")
    made.send("X10\r")
    live = Stepped(made)
    live.step(5)
    assert live.rows[loop.PASSED] == loop.PASSED_KINEMATICS
    assert made.memory.I[kernel.kinematics] == 0
    assert made.memory.I[mf1.word[0]] & mf1.KILL_ALL_MOVES_REQUEST
    assert made.memory.I[threads.state[loop.FIRST_KINEMATICS]] == THREAD_AWAY
