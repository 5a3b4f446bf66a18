"""Ticks that change nothing but the clocks are left out, and the state is the same to the bit."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.search import search

from openacr import compiled
from openacr.controller import Controller
from openacr.controller.engine_run import EngineRun
from openacr.engine import quiet_cy
from openacr.engine.watches import Watch, Watched
from openacr.map.numbers import W_MISC_INPUTS
from openacr.map.rows import machine_devices
from openacr.models import ACR9040
from openacr.plant.describe import schema

pytestmark = pytest.mark.skipif(
    not compiled.is_compiled, reason="as plain Python no tick is left out"
)

AXES = (
    "SYS",
    "DIM P(100)",
    "PROG0",
    "ATTACH MASTER0",
    'ATTACH SLAVE0 AXIS0 "X"',
    'ATTACH SLAVE1 AXIS1 "Y"',
)
LIMITS = ("PPU X1000 Y1000", "ACC 1000 DEC 1000 STP 1000 VEL 50", "DRIVE ON X Y")
JOGS = ("JOG VEL X20 Y20", "JOG ACC X1000 Y1000", "JOG DEC X1000 Y1000")


def engine_of(card: Controller) -> EngineRun:
    return card._engine


def card_of(*lines: str, leaves_out: bool = True) -> Controller:
    """A card with two modelled axes, set up by these lines."""
    card = Controller(ACR9040)
    card.leave_out_rest(leaves_out)
    answered(card, *AXES, *LIMITS, *JOGS, *lines)
    return card


def left_out(card: Controller) -> int:
    """Ticks left out in the rest that lasts at present."""
    return engine_of(card)._seen[quiet_cy.LEFT_OUT]


def both(*lines: str) -> tuple[Controller, Controller]:
    return card_of(*lines), card_of(*lines, leaves_out=False)


def test_of_ten_seconds_at_rest_nearly_all_ticks_are_left_out() -> None:
    quick, full = both()
    for card in (quick, full):
        card.advance(seconds=10.0)
    assert left_out(quick) > 0.9 * 10.0 / quick.period_s
    assert left_out(full) == 0
    assert quick.digest() == full.digest()
    known = engine_of(quick)._seen[quiet_cy.KNOWN]
    assert known & quiet_cy.PLCS_IDLE  # so whole rows of ticks pass at once


PROJECTS = sorted(
    {path.parent for path in (Path(__file__).parents[2] / "examples").glob("*/setup.8k")}
)
PROGRAMS = (
    ("10 P0=P0+1", "20 DWL 1.3", "30 GOTO 10"),
    ("10 INH 32", "20 P1=P1+1", "30 INH -32", "40 GOTO 10"),
    ("10 SET 40", "20 DWL 2", "30 CLR 40", "40 X/1", "50 DWL 2", "60 GOTO 10"),
    ("10 IHPOS P6916(9000,0)", "20 SET 41"),
    ("10 INH 82", "20 SET 42", "30 INH -82", "40 CLR 42", "50 GOTO 10"),
    ("10 DWL 3", "20 JOG FWD X", "30 DWL 1", "40 JOG OFF X", "50 DWL 0.4", "60 GOTO 10"),
    ("10 X1", "20 INH -516", "30 X0", "40 INH -516", "50 DWL 0.9", "60 GOTO 10"),
)
RESTS = (  # a card that follows a clock while its axes rest, or seems to
    ("HLBIT X80", "HLIM X3"),
    ("GEAR SRC X CLK", "GEAR PPU X1000", "GEAR RATIO X0.01", "GEAR ON X"),
    ("GEAR SRC X P6916", "GEAR PPU X1000", "GEAR RATIO X0.01", "GEAR ON X"),
    ("GEAR SRC X P6656", "GEAR PPU X1000", "GEAR RATIO X0.01", "GEAR ON X"),
    ("EXC X100", "TLM X0", "IDELAY X0.3", "IGAIN X1", "ILIMIT X9", "VEL 100", "X0.2"),
    ("FSTAT 0 (27,0,0)", "FSTAT PERIOD 1", "FSTAT ON"),
    (
        "DIM LA(1)",
        "DIM LA0(1000)",
        "SAMP 0 SRC P6916",
        "SAMP 0 BASE LA0",
        "P6915=7",
        "SAMP TRG -BIT82",
        "SET 104",
    ),
    ("PM DB X0.01", "PM ON X", "DRIVE OFF X"),
    ("GEAR SRC X ENC1", "GEAR ON X IHPOS P6916(3000,0)"),
    ("VEL 0.2", "X3"),
    ("SET 32", "CLR 32"),
)
PLCS = (
    ("10 LD 80", "20 OUT 43"),
    ("10 LD NOT 96", "20 TIM 0 1500", "30 LD TIM 0", "40 OUT 44"),
    ("10 LD 32", "20 OUT 45"),
)


def answered(card: Controller, *lines: str) -> None:
    """Type lines; each is taken without an error."""
    for line in lines:
        assert card.send(line + "\r").count("\r\n") == 1, line


def rest_in_pieces(cards: tuple[Controller, Controller]) -> int:
    """Advance both cards alike and compare them; returns ticks left out in the longest rest."""
    most = 0
    for ticks in (60, 29, 47, 81, 157, 350, 640, 1333, 9000, 3, 20000):
        engine_of(cards[0])._seen[quiet_cy.PAUSE] = 20
        for card in cards:
            card.advance(ticks)
        assert cards[0].digest() == cards[1].digest(), ticks
        most = max(most, left_out(cards[0]))
    assert left_out(cards[1]) == 0
    return most


@pytest.mark.parametrize("lines", PROGRAMS)
def test_while_a_program_waits_and_acts_the_state_is_that_of_ticks_in_full(
    lines: tuple[str, ...],
) -> None:
    cards = both()
    for card in cards:
        answered(card, *lines, "RUN")
    rest_in_pieces(cards)


@pytest.mark.parametrize("lines", RESTS)
def test_a_card_that_follows_a_clock_at_rest_has_the_state_of_ticks_in_full(
    lines: tuple[str, ...],
) -> None:
    cards = both()
    for card in cards:
        answered(card, *lines)
    rest_in_pieces(cards)


@pytest.mark.parametrize("lines", PLCS)
def test_while_plcs_scan_the_state_is_that_of_ticks_in_full(lines: tuple[str, ...]) -> None:
    cards = both()
    for card in cards:
        card.send("PLC0\r")
        card.send("".join(f"{line}\r" for line in lines) + "RUN\rPROG0\r")
    most = rest_in_pieces(cards)
    assert most > 1000 or "80" in lines[0]


@pytest.mark.parametrize("line", ["RUN", "HALT ALL"])
@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_of_every_example_the_state_is_that_of_ticks_in_full(project: Path, line: str) -> None:
    cards = (Controller.from_project(project), Controller.from_project(project))
    cards[1].leave_out_rest(False)
    for card in cards:
        card.send(f"PROG0\r{line}\r")
    rest_in_pieces(cards)


def test_a_device_that_is_stepped_seldom_is_stepped_at_its_tick_of_a_rest() -> None:
    described = schema.default_world(ACR9040).card
    gripper = schema.DeviceTable(
        kind="gripper", name="jaw", outputs={"close": 33}, inputs={"gripped": 12}, period_s=0.9
    )
    cards = (
        Controller(ACR9040, world=schema.World(card=described, device=(gripper,))),
        Controller(ACR9040, world=schema.World(card=described, device=(gripper,))),
    )
    cards[1].leave_out_rest(False)
    for _ in range(3):
        engine_of(cards[0])._seen[quiet_cy.PAUSE] = 20
        for card in cards:
            due_tk = int(card.memory.F[machine_devices.due_tk])
            card.advance(due_tk - card.clock.tick)
        assert cards[0].digest() == cards[1].digest()
    cards[0].advance(1000)
    assert left_out(cards[0]) > 500


def test_a_flag_or_value_that_is_waited_for_at_rest_ends_it_at_its_tick() -> None:
    cards = both()
    minute = Watch(Watched.WORD, W_MISC_INPUTS, 1 << 19)
    for card in cards:
        card.advance(seconds=2.0)
        assert card.until(82, False, timeout_s=2.0)
        assert card.until(82, True, timeout_s=2.0)
        at_ms = card.clock.tick
        card.watch([minute])
        card.advance(seconds=90.0)
        assert (at_ms, card.clock.tick) == (6000, 60_000)
    assert cards[0].digest() == cards[1].digest()


def test_a_trace_of_a_rest_has_every_sample() -> None:
    cards = both()
    traces = []
    for card in cards:
        card.advance(seconds=1.0)
        card.record(7)
        card.advance(seconds=3.0)
        traces.append(card.take_trace())
    assert len(traces[0].time_s) == len(traces[1].time_s) > 800
    assert list(traces[0].time_s) == list(traces[1].time_s)


ACTS = st.sampled_from(
    [
        *(("HALT", "NEW", *lines, "RUN") for lines in PROGRAMS),
        *RESTS,
        *(("PLC0", "HALT", "NEW", *lines, "RUN", "PROG0") for lines in PLCS),
        ("HALT",),
        ("GEAR OFF X",),
        ("SET 32",),
        ("CLR 32",),
        ("X/0.5",),
        ("JOG INC Y0.3",),
        ("FSTAT OFF",),
        ("DRIVE ON X Y", "CLR 8467"),
        ("P12304=0.5",),
    ]
)


@search(60, deadline=None)
@given(steps=st.lists(st.tuples(ACTS, st.integers(1, 9000)), min_size=1, max_size=6))
def test_whatever_is_typed_the_state_is_that_of_ticks_in_full(
    steps: list[tuple[tuple[str, ...], int]],
) -> None:
    quick, full = both()
    for lines, ticks in steps:
        engine_of(quick)._seen[quiet_cy.PAUSE] = 20
        for card in (quick, full):
            card.send("".join(f"{line}\r" for line in lines))
            card.advance(ticks)
        assert quick.digest() == full.digest(), lines
