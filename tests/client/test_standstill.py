"""STOP on the card: motion of every kind comes to rest, and only that is stopped."""

import pytest
from tests.client.cards import AXIS

from openacr.client import Card, Level
from openacr.client.errors import RefusedError
from openacr.client.standstill import EVERY_S, KILLED_S, WATCH_S, Standstill
from openacr.controller import Controller
from openacr.map.rows import axes
from openacr.protocol.bits import ClearBit, SetBit

JOG_FORWARD, CYCLE_START, KILL_ALL_MOVES, STOP_ALL_MOVES, INHIBIT = 796, 521, 522, 523, 540
MOVES = ("_again", "X20 Y0", "X0 Y10", "GOTO again")


class Machine:
    """Two axes of PROG0, one of PROG1; `host` stops, `other` is who began the motion."""

    def __init__(self) -> None:
        self.controller = Controller()
        self.host = Card.open(self.controller)
        self.other = Card.open(self.controller)
        for line in (*AXIS[1:], 'ATTACH SLAVE1 AXIS1 "Y"', "PPU Y1000", "DRIVE ON Y"):
            self.typed(line)
        self.typed("JOG ACC X1000 Y1000", "JOG DEC X1000 Y1000", "JOG VEL X50 Y50")
        self.typed("ATTACH MASTER1", 'ATTACH SLAVE0 AXIS2 "Z"', "PPU Z1000", program=1)
        self.typed("DRIVE ON Z", "ACC 1000 DEC 1000 STP 1000 VEL 100", program=1)

    def typed(self, *lines: str, program: int = 0) -> None:
        for line in lines:
            self.other.command(line, program=program)

    def program(self, number: int, *lines: str) -> None:
        for line in ("PROGRAM", *lines, "ENDP"):
            self.other.command(line, program=number)
        self.other.run(number)

    def system(self, line: str) -> None:
        self.other.go(Level())
        self.other.command(line)

    def setpoints(self) -> list[float]:
        return [self.controller.p[row] for row in axes.primary_setpoint]

    def moves(self) -> bool:
        before = self.setpoints()
        self.controller.advance(seconds=0.3)
        return self.setpoints() != before

    def stop(self, *, ends: bool = False) -> Standstill:
        stop = Standstill(self.host, ends=ends)
        stop.watch()
        return stop


@pytest.fixture
def machine() -> Machine:
    return Machine()


def by_jog(machine: Machine) -> None:
    machine.typed("JOG FWD X")


def by_jog_backwards(machine: Machine) -> None:
    machine.typed("JOG REV Y")


def by_jog_to_a_place(machine: Machine) -> None:
    machine.typed("JOG INC X500")


def by_jog_flag_of_a_packet(machine: Machine) -> None:
    machine.other.tell(SetBit(JOG_FORWARD))


def by_typed_move(machine: Machine) -> None:
    machine.typed("X500 Y300")


def by_gear(machine: Machine) -> None:
    machine.typed("GEAR SRC Y CLK", "GEAR PPU Y1000", "GEAR RATIO Y1", "GEAR ON Y")


def by_cam(machine: Machine) -> None:
    machine.typed("DIM LA(1)", "DIM LA0(4)", "LA0(0)=0", "LA0(1)=2000", "LA0(2)=4000", "LA0(3)=0")
    machine.typed("CAM DIM X1", "CAM SEG X(0,1000000,LA0)", "CAM SRC X CLK", "CAM ON X")


def by_hand_wheel(machine: Machine) -> None:
    machine.typed("HDW SRC X CLK", "HDW VEL X50", "HDW ACC X1000", "HDW ON X")


def by_filter(machine: Machine) -> None:
    machine.typed("FLT SRC Y CLK", "FLT COEF Y4", "FLT ON Y")


def by_program(machine: Machine) -> None:
    machine.program(0, *MOVES)


def by_another_master(machine: Machine) -> None:
    machine.program(1, "_again", "Z20", "Z0", "GOTO again")


def by_program_that_jogs(machine: Machine) -> None:
    machine.program(3, "_again", "SET 796", "DWL 0.01", "GOTO again")


EVERY = (
    by_jog, by_jog_backwards, by_jog_to_a_place, by_jog_flag_of_a_packet, by_typed_move, by_gear,
    by_cam, by_hand_wheel, by_filter, by_program, by_another_master, by_program_that_jogs,
)  # fmt: skip


@pytest.mark.parametrize("ends", [False, True])
@pytest.mark.parametrize("begin", EVERY)
def test_motion_of_every_kind_comes_to_rest_within_the_watch(
    machine: Machine, begin: object, ends: bool
) -> None:
    assert callable(begin)
    begin(machine)
    machine.controller.advance(seconds=0.3)
    assert machine.moves()
    before_s = machine.controller.tick * machine.controller.period_s
    stop = machine.stop(ends=ends)
    took_s = machine.controller.tick * machine.controller.period_s - before_s
    assert took_s == pytest.approx(WATCH_S, abs=0.2)
    assert stop.moving == ()
    assert stop.found
    assert not machine.moves()


def test_moves_and_programs_of_all_masters_go_on_where_they_were_held(machine: Machine) -> None:
    machine.typed("X500")
    machine.program(1, "Z300", "Z0", "Z300", "Z0", "Z100")
    machine.controller.advance(seconds=1.0)
    stop = machine.stop()
    assert stop.found == ["PROG1 paused", "MASTER0 held", "MASTER1 held"]
    assert stop.still_held()
    stop.resume()
    assert not stop.still_held()
    machine.controller.advance(seconds=20)
    assert machine.setpoints()[:3] == [500_000, 0, 100_000]


def test_what_was_resumed_elsewhere_is_held_no_more(machine: Machine) -> None:
    by_another_master(machine)
    machine.controller.advance(seconds=1.0)
    stop = machine.stop()
    assert stop.found == ["PROG1 paused", "MASTER1 held"]
    machine.other.tell(SetBit(CYCLE_START + 32))
    machine.controller.advance(seconds=0.5)
    assert stop.still_held()
    machine.other.command("RESUME PROG1")
    machine.controller.advance(seconds=0.5)
    assert not stop.still_held()


def test_after_an_end_nothing_is_resumed_and_the_axes_may_move_again(machine: Machine) -> None:
    by_program(machine)
    machine.controller.advance(seconds=0.5)
    stop = machine.stop(ends=True)
    assert stop.found == ["PROG0 halted", "MASTER0 stopped"]
    assert not stop.still_held()
    place = machine.setpoints()
    machine.controller.advance(seconds=1)
    assert machine.setpoints() == place
    machine.typed("X7 Y8")
    machine.controller.advance(seconds=2)
    assert machine.setpoints()[:2] == [7000, 8000]


def test_at_rest_a_stop_changes_nothing(machine: Machine) -> None:
    assert machine.stop().found == []
    machine.typed("X5")
    machine.controller.advance(seconds=1)
    assert machine.setpoints()[0] == 5000


def test_a_program_that_watches_over_the_card_goes_on(machine: Machine) -> None:
    machine.system("DIM P(10)")
    for number in (3, 4):
        machine.program(number, "_again", f"P{number}=P{number}+1", "DWL 0.01", "GOTO again")
    stop = Standstill(machine.host, spared={4})
    stop.watch()
    assert stop.found == ["PROG3 paused"]
    counts = [machine.controller.p[3], machine.controller.p[4]]
    machine.controller.advance(seconds=0.5)
    assert machine.controller.p[3] == counts[0]
    assert machine.controller.p[4] > counts[1] + 10


def test_what_a_plc_moves_again_and_again_is_reported(machine: Machine) -> None:
    machine.system("DIM PLC0(2000)")
    machine.other.go(Level.plc(0))
    for line in ("10 LDN 128", "20 OUT 796", "RUN"):
        machine.other.command(line)
    machine.controller.advance(seconds=0.3)
    assert machine.moves()
    assert machine.stop().moving == (0,)


def test_a_host_that_begins_again_is_stopped_again(machine: Machine) -> None:
    stop = Standstill(machine.host)
    stop.look()
    machine.typed("JOG FWD X")
    stop.watch()
    assert stop.found == ["AXIS0 stopped"]
    assert not machine.moves()


def ended(machine: Machine, seconds: float) -> Standstill:
    """A path that was ended, and the time since."""
    machine.typed("X900")
    machine.controller.advance(seconds=0.3)
    stop = Standstill(machine.host, ends=True)
    for _ in range(round(seconds / EVERY_S)):
        stop.look()
        machine.host.pause(EVERY_S)
    stop.look()
    assert (stop.found, stop.barred) == (["MASTER0 stopped"], set())
    return stop


def test_moves_that_a_host_sends_soon_after_an_end_are_killed(machine: Machine) -> None:
    stop = ended(machine, KILLED_S - EVERY_S)
    with pytest.raises(RefusedError, match="Master Kill All Moves Request Active"):
        machine.typed("X0")
    stop.watch()
    assert (stop.found, stop.barred) == (["MASTER0 stopped"], set())
    machine.typed("X7")
    machine.controller.advance(seconds=2)
    assert machine.setpoints()[0] == 7000


@pytest.mark.parametrize("seconds", [KILLED_S, WATCH_S - EVERY_S])
def test_moves_that_a_host_sends_later_do_not_begin_and_bar_the_master(
    machine: Machine, seconds: float
) -> None:
    stop = ended(machine, seconds)
    place = machine.setpoints()
    machine.typed("X0")  # its host goes on
    machine.host.pause(EVERY_S)
    assert machine.setpoints() == place
    assert not stop.is_over  # before all moves may begin
    stop.watch()
    assert stop.found == ["MASTER0 stopped and barred (its host sent more moves)"]
    assert stop.barred == {0}
    machine.controller.advance(seconds=0.5)
    assert [machine.controller.bit[flag] for flag in (KILL_ALL_MOVES, INHIBIT)] == [1, 0]
    assert machine.setpoints() == place


def test_moves_that_a_host_lets_begin_itself_are_ramped_down_and_barred(machine: Machine) -> None:
    stop = ended(machine, KILLED_S)
    machine.other.tell(ClearBit(INHIBIT))
    machine.typed("X0")
    machine.controller.advance(seconds=EVERY_S)
    stop.look()
    place = machine.setpoints()
    machine.controller.advance(seconds=0.005)
    assert machine.setpoints() != place  # a ramp
    stop.watch()
    assert stop.barred == {0}
    assert not machine.moves()
    flags = (KILL_ALL_MOVES, STOP_ALL_MOVES, INHIBIT)
    assert [machine.controller.bit[flag] for flag in flags] == [1, 0, 0]


@pytest.mark.parametrize("seconds", [0.2, KILLED_S])
def test_a_watch_that_is_ended_early_lets_moves_begin(machine: Machine, seconds: float) -> None:
    stop = ended(machine, seconds)
    stop.let_begin()
    machine.typed("X7")
    machine.controller.advance(seconds=2)
    assert machine.setpoints()[0] == 7000


def test_a_watch_that_is_ended_early_leaves_what_still_ramps_down_and_what_is_barred(
    machine: Machine,
) -> None:
    stop = ended(machine, 0.0)
    stop.let_begin()
    machine.controller.advance(seconds=0.5)
    assert machine.controller.bit[KILL_ALL_MOVES]
    machine.host.tell(ClearBit(KILL_ALL_MOVES))
    stop = ended(machine, KILLED_S)
    machine.typed("X0")
    stop.look()
    stop.let_begin()
    machine.controller.advance(seconds=0.1)
    assert machine.controller.bit[KILL_ALL_MOVES]


def test_an_inhibit_of_another_host_stays(machine: Machine) -> None:
    stop = ended(machine, 0.2)
    machine.other.tell(SetBit(INHIBIT))
    stop.watch()
    assert [machine.controller.bit[flag] for flag in (KILL_ALL_MOVES, INHIBIT)] == [0, 1]


def test_a_master_of_another_host_is_held_but_left_to_it(machine: Machine) -> None:
    machine.typed("X500")
    machine.typed("Z500", program=1)
    machine.controller.advance(seconds=0.5)
    stop = Standstill(machine.host, of_host={0})
    stop.watch()
    assert not machine.moves()
    stop.resume()
    machine.controller.advance(seconds=10)
    assert (machine.setpoints()[0] < 500_000, machine.setpoints()[2]) == (True, 500_000)


def test_the_moves_of_a_master_of_another_host_are_not_dropped(machine: Machine) -> None:
    machine.typed("X500")
    machine.typed("Z500", program=1)
    machine.controller.advance(seconds=0.5)
    Standstill(machine.host, ends=True, of_host={0}).watch()
    assert not machine.moves()
    machine.other.tell(SetBit(CYCLE_START), SetBit(CYCLE_START + 32))
    machine.controller.advance(seconds=10)
    assert (machine.setpoints()[0], machine.setpoints()[2] < 500_000) == (500_000, True)


def test_axes_that_a_spared_program_brings_to_rest_are_left_alone(machine: Machine) -> None:
    machine.typed("JOG FWD X Y")
    machine.controller.advance(seconds=0.3)
    stop = Standstill(machine.host, beside={0})
    stop.watch()
    assert (stop.moving, stop.found) == ((), ["AXIS1 stopped"])
    assert machine.moves()
