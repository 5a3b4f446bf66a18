"""What the interrupt leaves out while nothing else reads or writes is found by every reader."""

import pytest

from openacr.compiled import is_compiled
from openacr.controller import Controller
from openacr.engine import alone_cy
from openacr.map.rows import axes, kernel, tables
from openacr.models import ACR9040

SET_UP = (
    "DIM LA(2)",
    "DIM LA0(5)",
    "DIM LA1(400)",
    "LA0(1)=100 : LA0(2)=200 : LA0(3)=100",
    "ATTACH MASTER0",
    'ATTACH SLAVE0 AXIS0 "X"',
    'ATTACH SLAVE1 AXIS1 "Y"',
    "PPU X1000 Y1000",
    "ACC 1000 DEC 1000 STP 1000 VEL 50",
    "JOG VEL X20 Y20",
    "JOG ACC X1000 Y1000",
    "JOG DEC X1000 Y1000",
    "DRIVE ON X Y",
)
MOVE = ("X9",)
JOG = ("JOG FWD X", "JOG REV Y")
GEAR = ("GEAR SRC Y ENC0", "GEAR RATIO Y0.3", "GEAR ON Y", "X5")
CAM = ("CAM DIM Y1", "CAM SEG Y(0,400,LA0)", "CAM SRC Y ENC0", "CAM ON Y", "X5")
CHAIN = ("CAM DIM Y2", "CAM SEG Y(0,300,LA0)", "CAM SEG Y(1,500,LA0)", *CAM[2:])
RUNGS = ("LD NOT 128 TIM 0 100", "LD TIM0 SET 128")  # sets flag 128 after 100 ms
TIMED = ("SYS", "DIM PLC0(100)", "PLC0", "PROGRAM", *RUNGS, "ENDP", "RUN", "PROG0")
LIVES = {
    "move": MOVE,
    "jog": JOG,
    "jog to a target": ("JOG ABS X0.4", "JOG INC Y-0.7"),
    "gear": GEAR,
    "cam": CAM,
    "cam of two arrays": CHAIN,
    "ballscrew": ("BSC DIM X1", "BSC SEG X(0,4000,LA0)", "BSC ON X", *MOVE),
    "backlash": ("BKL X0.1", "X1"),
    "sampler": ("SAMP 0 SRC P12294", "SAMP 0 BASE LA1", "P6915=1", "SET 104", *MOVE),
    "sampled cam": (*CAM, "SAMP 0 SRC P12294", "SAMP 0 BASE LA0", "P6915=20", "SET 104"),
    "source by number": ("GEAR SRC Y P12294", "GEAR RATIO Y0.3", "GEAR ON Y", "X5"),
    "capture of the setpoint": ("INTCAP X11", "SET 833", *MOVE),
    "hold": (*MOVE, "DWL 0.05", "SET 519"),
    "kill": (*JOG, "DWL 0.1", "SET 8467"),
    "limit of the jog": ("SLM X(0.7,-0.7)", "SLIM X3", "JOG FWD X"),
    "limit of another axis": ("SLM Y(0.7,-0.7)", "SLIM Y3", *JOG),
    "limit of a jog without speed": ("HLBIT X128", "HLIM X3", *TIMED, "JOG VEL X0", "JOG FWD X"),
    "hand wheel": ("HDW SRC Y ENC0", "HDW PPU Y1000", "HDW RATIO Y1", "HDW ON Y", "X5"),
}
TICKS = 400
PART = TICKS if is_compiled else 100  # plain Python is slow


def card_of(*lines: str) -> Controller:
    """A card with two modelled axes that has typed these lines."""
    card = Controller(ACR9040)
    for line in ("PROG0", *SET_UP, *lines):
        answer = card.send(line + "\r")
        assert answer.count("\r\n") == 1, answer
    return card


@pytest.mark.parametrize("name", LIVES)
def test_ticks_in_one_call_show_what_ticks_in_full_show(name: str) -> None:
    whole, pieces = card_of(*LIVES[name]), card_of(*LIVES[name])
    for _ in range(3):
        whole.advance(PART)
        for _ in range(PART):
            pieces.advance(1)  # fewer than CALM: each tick in full
        assert whole.digest() == pieces.digest()
    assert alone_cy.CALM > 1


@pytest.mark.parametrize("name", ["move", "jog", "cam"])
def test_a_call_ends_with_everything_shown(name: str) -> None:
    card = card_of(*LIVES[name])
    card.advance(100)
    rows, reals = card.memory.I, card.memory.F
    for axis in (0, 1):
        assert rows[axes.primary_setpoint[axis]] == round(reals[axes.psp_cnt[axis]])
        assert rows[axes.jog_offset[axis]] == round(reals[axes.jog_cnt[axis]])
        assert not rows[axes.show_due[axis]]
    assert not rows[kernel.untouched] | rows[kernel.unread] | rows[kernel.shows_due]
    assert not any(rows[place] for place in tables.header)


def test_a_program_reads_in_each_tick_where_the_axis_is() -> None:
    """The first statement after 50 ms without one reads what was put off meanwhile."""
    card = card_of(*JOG, "SYS", "DIM P(10)", "PROG1")
    for line in ("PROGRAM", "10 DWL 0.05", "20 P0=P12297", "30 GOTO 10", "ENDP", "RUN"):
        card.send(line + "\r")
    pieces = Controller(ACR9040)
    pieces.restore(card.snapshot())
    card.advance(TICKS)
    for _ in range(TICKS):
        pieces.advance(1)
    assert card.p[0] > 1000
    assert card.digest() == pieces.digest()


JOGS_ASKED = {  # what a PLC does to a jog that has been at speed
    "stop": "SET 795",
    "end": "CLR 796",
    "other direction too": "SET 797",
}


@pytest.mark.parametrize("jog", ["JOG FWD X", "JOG ABS X3"])
@pytest.mark.parametrize("name", JOGS_ASKED)
def test_a_flag_that_a_plc_writes_reaches_a_jog_in_full_speed(name: str, jog: str) -> None:
    """Nothing but the interrupt and a PLC acts, hundreds of ticks long."""
    plc = ("DIM PLC0(100)", "PLC0", "PROGRAM", "LD 794", JOGS_ASKED[name], "ENDP", "RUN")
    whole = card_of("SYS", *plc, "PROG0", jog)
    pieces = Controller(ACR9040)
    pieces.restore(whole.snapshot())
    for _ in range(3):
        whole.advance(TICKS)
        for _ in range(TICKS):
            pieces.advance(1)
        assert whole.digest() == pieces.digest()


def test_an_idle_plc_acts_once_a_program_has_set_its_timer() -> None:
    card = card_of("SYS", "DIM P(10)", "PROG1")
    lines = ("10 DWL 0.05", "20 SET 1553", "30 DWL 0.05", "40 CLR 1553", "50 GOTO 10")
    for line in ("PROGRAM", *lines, "ENDP", "RUN"):
        card.send(line + "\r")
    pieces = Controller(ACR9040)
    pieces.restore(card.snapshot())
    card.advance(350)
    for _ in range(350):
        pieces.advance(1)
    assert card.bit[1553] and card.bit[1552]  # its input and, at once, its output
    assert card.digest() == pieces.digest()


def test_a_value_written_between_calls_acts_in_the_next_tick() -> None:
    card = card_of(*JOG)
    card.advance(200)
    offset_cnt = card.p[axes.jog_offset[0]]
    card.p[axes.jog_offset[0]] = offset_cnt + 5000
    card.advance(200)
    speed_cnt = 20 * 1000 * card.period_s  # of a tick
    assert card.p[axes.jog_offset[0]] == pytest.approx(offset_cnt + 5000 + 200 * speed_cnt, abs=1)


def test_a_new_jog_speed_between_calls_is_taken_up() -> None:
    card = card_of(*JOG)
    card.advance(400)
    card.send("JOG VEL X30\r")
    card.advance(400)
    assert card.p[axes.current_jog_veloc[0]] == 30.0
    assert card.p[axes.current_jog_veloc[1]] == -20.0


def test_an_array_that_is_gone_switches_its_cam_off_in_the_next_tick() -> None:
    card = card_of(*CAM)
    card.advance(200)
    assert card.bit[790 + 32]
    card.send("CLEAR\r")
    card.advance(1)
    assert not card.bit[790 + 32]
