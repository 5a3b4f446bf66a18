"""Virtual push buttons in place of wired switches."""

from collections.abc import Callable

import pytest
from tests.panel.bench import HandStation

from openacr.sysvar.tabs import CONTROL, IO, OFFSETS

SKIP, OPTIONAL, HOLD, START = 9, 10, 11, 12
PROGRAM = "G21 G90 G54\nG0 X10 Y10 Z60\nG1 X40 F1200\n/G1 Y40\nM1\nG1 X10\nM2\n"


@pytest.fixture
def wired(hand: HandStation) -> HandStation:
    """A machine with four switches, of which start is inverted, and a button for each."""
    store = hand.installation.store
    cells = (IO.block_skip, IO.optional_stop, IO.feedhold_input, IO.cycle_start_input)
    for n, (cell, line) in enumerate(zip(cells, (SKIP, OPTIONAL, HOLD, START), strict=True)):
        store.write(cell, line)
        store.write_text(OFFSETS.button_caption[n], f"Switch {n}")
        store.write(OFFSETS.button_set_bit[n], line)
        store.write(OFFSETS.button_mode[n], 1 if line in (SKIP, OPTIONAL) else 0)
    hand.station.renew(hand.now_s)
    hand.run(0.1)
    (hand.installation.programs / "t.nc").write_text(PROGRAM)
    hand.do("program.load", path="t.nc")
    hand.run(0.1)
    return hand


def by_button(hand: HandStation, line: int, on: bool) -> None:
    toggles = line in (SKIP, OPTIONAL)
    hand.do("button", number=line - SKIP, pressed=True if toggles else on)
    if toggles:
        hand.do("button", number=line - SKIP, pressed=False)
    hand.run(0.1)


def by_wire(hand: HandStation, line: int, on: bool) -> None:
    hand.station.link.machine.card.write_bit(line, on)
    hand.run(0.1)


def is_held(hand: HandStation) -> bool:
    """Whether a program that is started stays at its first block."""
    hand.do("run.begin")
    hand.run(0.5)
    is_paused = hand.state == "PAUSED"
    hand.do("run.abort")
    hand.until(lambda: not hand.is_busy)
    return is_paused


@pytest.mark.req("MILL-DISP-VPB-ACT")
@pytest.mark.parametrize("switch", [by_button, by_wire])
def test_a_button_acts_as_the_switch_that_is_wired_to_its_input(
    wired: HandStation, switch: Callable[[HandStation, int, bool], None]
) -> None:
    hand = wired
    switch(hand, SKIP, True)
    switch(hand, OPTIONAL, True)
    hand.do("run.begin")
    hand.until(lambda: hand.station.snapshot.line == 3)
    switch(hand, HOLD, True)
    hand.until(lambda: hand.state == "PAUSED")
    switch(hand, START, True)
    switch(hand, START, False)
    assert hand.state == "PAUSED"  # the hold is still pressed
    switch(hand, HOLD, False)
    assert hand.state == "PAUSED"
    switch(hand, START, True)
    hand.until(lambda: hand.state == "HOLD")  # M1, as the optional stop is on
    switch(hand, START, False)
    assert hand.station.snapshot.work[1] == 10.0  # Y 40 was skipped
    switch(hand, START, True)
    hand.until(lambda: not hand.is_busy)
    switch(hand, START, False)
    switch(hand, SKIP, False)
    switch(hand, OPTIONAL, False)
    hand.do("run.begin")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.station.snapshot.work[:2] == (10.0, 40.0)


def test_a_held_button_of_an_input_is_let_go_with_its_browser(wired: HandStation) -> None:
    hand = wired
    hand.do("button", number=HOLD - SKIP, pressed=True)
    hand.run(0.1)
    assert is_held(hand)
    hand.station.leave(1)
    hand.station.join(hand.me)
    hand.run(0.1)
    assert not is_held(hand)


def test_a_screen_cannot_let_an_input_go_that_is_wired_on(wired: HandStation) -> None:
    hand = wired
    hand.station.link.machine.card.write_bit(HOLD, True)
    hand.run(0.1)
    by_button(hand, HOLD, True)
    by_button(hand, HOLD, False)
    assert is_held(hand)


def test_an_inverted_input_is_active_while_its_button_is_pressed(wired: HandStation) -> None:
    hand = wired
    hand.station.link.machine.card.write_bit(HOLD, True)  # active is off now
    hand.installation.store.write(CONTROL.input_inverted[HOLD], 1)
    hand.station.renew(hand.now_s)
    hand.run(0.1)
    hand.do("button", number=HOLD - SKIP, pressed=True)
    hand.run(0.1)
    assert is_held(hand)
    hand.do("button", number=HOLD - SKIP, pressed=False)
    hand.run(0.1)
    assert not is_held(hand)
