"""Breakpoints of the bench: programs of the card in the panel's process are held before lines."""

from pathlib import Path
from typing import Any

import pytest
from tests.panel.bench import HandStation
from tests.panel.test_card_programs import sent

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.panel.control.engineer.card_programs import read_states
from openacr.panel.control.engineer.on_card import NO_BREAKPOINTS, OnCard
from openacr.panel.control.machine.installation import Installation
from openacr.sysvar.store import Store

COUNTING = (
    "PROGRAM\nDIM LV(1)\n_more\nP10 = P10+1\nGOSUB sub\nP12 = P12+1\nDWL 0.05\nGOTO more\n"
    "_sub\nP11 = P11+1\nRETURN\nENDP\n"
)
COUNT, CALL, AFTER, IN_SUB = 40, 50, 60, 100  # its lines
TICKING = "PROGRAM\n_more\nP20 = P20+1\nDWL 0.01\nGOTO more\nENDP\n"


def card(hand: HandStation) -> Controller:
    history = hand.installation.history
    assert history is not None
    return history.card


def fact(hand: HandStation) -> dict[str, Any]:
    return hand.events("breakpoints")[-1]


def held(hand: HandStation) -> list[tuple[int, int]]:
    return [(each["program"], each["line"]) for each in fact(hand)["held"]]


def stopped(hand: HandStation, line: int) -> dict[str, Any]:
    """Wait until PROG3 is held before a line; the fact of it."""
    hand.until(lambda: held(hand) == [(3, line)])
    found: dict[str, Any] = fact(hand)["held"][0]
    return found


@pytest.fixture
def running(hand: HandStation) -> HandStation:
    """PROG3 with a breakpoint before it counts in P10, and PROG4 that counts in P20, both run."""
    sent(hand, COUNTING)
    sent(hand, TICKING, program=4)
    hand.do("break.set", program=3, line=COUNT)
    hand.do("card.run", program=4)
    hand.do("card.run", program=3)
    stopped(hand, COUNT)
    return hand


def test_a_program_is_held_before_the_line_and_the_others_run_on(running: HandStation) -> None:
    hand, values = running, card(running).p
    assert values[10] == 0
    before = values[20]
    hand.run(0.5)
    assert values[10] == 0
    assert values[20] > before + 20
    hand.do("card.go", program=3)
    hand.until(lambda: values[10] == 1 and held(hand) == [(3, COUNT)])
    assert values[12] == 1
    hand.run(0.2)
    assert values[10] == 1


def test_a_step_passes_a_routine_enters_it_or_leaves_it(running: HandStation) -> None:
    hand, values = running, card(running).p
    hand.do("break.clear")
    hand.do("card.go", program=3, how="over")
    assert stopped(hand, CALL)["why"] == "step"
    hand.do("card.go", program=3, how="into")
    stopped(hand, IN_SUB)
    assert values[11] == 0
    hand.do("card.go", program=3, how="out")
    stopped(hand, AFTER)
    assert values[11] == 1
    hand.do("break.set", program=3, line=CALL)
    hand.do("card.go", program=3)
    assert stopped(hand, CALL)["why"] == "breakpoint"
    hand.do("card.go", program=3, how="over")
    stopped(hand, AFTER)
    assert (values[10], values[11], values[12]) == (2, 2, 1)


def test_a_condition_holds_where_it_is_not_zero_and_a_bad_one_holds_with_its_reason(
    running: HandStation,
) -> None:
    hand, values = running, card(running).p
    hand.do("break.set", program=3, line=COUNT, condition="P10 = 3")
    assert fact(hand)["breakpoints"] == [{"program": 3, "line": COUNT, "condition": "P10 = 3"}]
    hand.do("card.go", program=3)
    hand.until(lambda: values[10] == 3 and held(hand) == [(3, COUNT)])
    hand.do("break.set", program=3, line=COUNT, condition="LV7")
    first = fact(hand)["held"][0]["hit"]
    hand.do("card.go", program=3)
    hand.until(lambda: held(hand) == [(3, COUNT)] and fact(hand)["held"][0]["hit"] > first)
    assert any("LV7" in text for text in hand.said)


def test_a_held_program_holds_its_motion_along_the_path_and_continues_it(
    hand: HandStation,
) -> None:
    sent(hand, "PROGRAM\nPRINT 1\nENDP\n")
    history = card(hand)
    for line in ("PROG3", "ATTACH MASTER1", 'ATTACH SLAVE0 AXIS3 "X"', "ACC 100 DEC 100 VEL 1000"):
        history.send(f"{line}\r")
    sent(hand, "PROGRAM\nX3000\nP10 = 1\nINH -517\nP10 = 2\nENDP\n")
    hand.do("break.set", program=3, line=30)
    hand.do("card.run", program=3)
    stopped(hand, 30)
    axis = history.axis(3)
    hand.run(0.5)
    first = axis.commanded_cnt
    hand.run(0.5)
    assert axis.commanded_cnt == first < 3000
    hand.do("card.go", program=3)
    hand.until(lambda: axis.commanded_cnt == 3000)


# --- PLCs -----------------------------------------------------------------------------

LADDER = "10 LD 130\n20 AND 131\n30 OUT 132\n40 LD 133\n50 OUT 134\n60 LD 135\n70 OUT 136\n"
RUNNING, FIRST_SCAN = 1536, 1537  # flags of PLC0


@pytest.fixture
def scanning(hand: HandStation) -> HandStation:
    """PLC0 runs, with a breakpoint at the coils of 132 and 134; FIRST_SCAN is over."""
    card(hand).send("SYS\rDIM PLC0(2000)\r")
    sent(hand, LADDER, plc=0)
    hand.do("break.set", plc=0, line=30)
    hand.do("break.set", plc=0, line=50)
    hand.do("card.run", plc=0)
    hand.run(0.05)
    assert (card(hand).bit[RUNNING], fact(hand)["held"]) == (True, [])
    return hand


def held_plc(hand: HandStation) -> list[tuple[int, int]]:
    return [(each["plc"], each["line"]) for each in fact(hand)["held"]]


def test_a_plc_is_held_after_the_scan_that_changes_a_coil_and_goes_on_as_it_was(
    scanning: HandStation,
) -> None:
    hand, bits = scanning, card(scanning).bit
    bits[135] = True  # of a coil without a breakpoint
    hand.run(0.05)
    assert (bits[136], fact(hand)["held"]) == (True, [])
    bits[133] = True
    hand.until(lambda: held_plc(hand) == [(0, 50)])
    assert (bits[134], bits[RUNNING]) == (True, False)
    bits[130] = bits[131] = True
    hand.run(0.1)
    assert not bits[132]  # no scan
    first = fact(hand)["held"][0]["hit"]
    hand.do("card.go", plc=0)
    hand.until(lambda: held_plc(hand) == [(0, 30)])
    assert fact(hand)["held"][0]["hit"] == first + 1
    assert bits[132]
    hand.do("card.go", plc=0)
    assert not bits[FIRST_SCAN]
    hand.run(0.05)
    assert (bits[RUNNING], fact(hand)["held"]) == (True, [])
    bits[130] = False
    hand.until(lambda: held_plc(hand) == [(0, 30)])
    assert not bits[132]
    hand.do("break.clear", plc=0, line=30)
    assert held_plc(hand) == [(0, 30)]
    hand.do("card.go", plc=0)
    bits[130] = True
    hand.run(0.1)
    assert (bits[132], fact(hand)["held"]) == (True, [])


def test_the_condition_of_a_plc_is_asked_then_and_a_halted_plc_is_not_held(
    scanning: HandStation,
) -> None:
    hand, bits = scanning, card(scanning).bit
    hand.do("break.set", plc=0, line=30, condition="BIT133 = 0")
    assert fact(hand)["breakpoints"] == [
        {"plc": 0, "line": 30, "condition": "BIT133 = 0"}, {"plc": 0, "line": 50, "condition": ""},
    ]  # fmt: skip
    hand.do("break.clear", plc=0, line=50)
    bits[133] = bits[130] = bits[131] = True
    hand.run(0.05)
    assert (bits[132], bits[RUNNING]) == (True, True)
    bits[133] = bits[131] = False
    hand.until(lambda: held_plc(hand) == [(0, 30)])
    bits[132] = True  # by another program, while the PLC is held
    hand.run(0.05)
    assert held_plc(hand) == [(0, 30)]
    first = fact(hand)["held"][0]["hit"]
    hand.do("card.run", plc=0)  # anew: its scan takes the flag back
    hand.until(lambda: held_plc(hand) == [(0, 30)] and fact(hand)["held"][0]["hit"] == first + 1)
    assert not bits[132]


def test_a_plc_with_another_text_is_no_longer_held_and_its_new_coils_are_watched(
    scanning: HandStation,
) -> None:
    hand, bits = scanning, card(scanning).bit
    bits[133] = True
    hand.until(lambda: held_plc(hand) == [(0, 50)])
    sent(hand, LADDER.replace("OUT 134", "OUT 140"), plc=0)
    hand.until(lambda: fact(hand)["held"] == [])
    assert "PLC0 is not held at a breakpoint: RUN starts it" in str(hand.refused("card.go", plc=0))
    bits[133] = False
    hand.do("card.run", plc=0)
    hand.run(0.1)
    assert fact(hand)["held"] == []
    bits[133] = True
    hand.until(lambda: held_plc(hand) == [(0, 50)])
    assert bits[140]


def test_what_a_plc_cannot_do_is_refused_with_the_reason(scanning: HandStation) -> None:
    hand = scanning
    assert "PLC0 line 20: no coil of a PLC on this line" in str(
        hand.refused("break.set", plc=0, line=20)
    )
    assert "it has no steps, only GO ON" in str(hand.refused("card.go", plc=0, how="over"))
    assert "name" in str(hand.refused("break.set", line=20))
    many = "".join(f"{n} LD 200 OUT {300 + n}\n" for n in range(1, 66))
    card(hand).send("SYS\rDIM PLC1(9000)\r")
    sent(hand, many, plc=1)
    for line in range(1, 63):
        hand.do("break.set", plc=1, line=line)
    assert "64 breakpoints are set" in str(hand.refused("break.set", plc=1, line=63))
    hand.do("break.clear", plc=1)
    assert [each["line"] for each in fact(hand)["breakpoints"]] == [30, 50]


def test_lines_without_a_statement_unknown_lines_and_programs_of_the_machine_are_refused(
    hand: HandStation,
) -> None:
    sent(hand, COUNTING)
    for line in (30, 45):
        assert f"PROG3 line {line}: nothing is executed" in str(
            hand.refused("break.set", program=3, line=line)
        )
    assert "belongs to this machine" in str(hand.refused("break.set", program=7, line=10))
    assert "does not run" in str(hand.refused("card.go", program=3))
    assert "name the program" in str(hand.refused("break.clear", line=10))
    assert fact(hand)["breakpoints"] == []


def test_every_browser_gets_the_breakpoints_and_they_are_removed_one_by_one_or_all(
    hand: HandStation,
) -> None:
    sent(hand, COUNTING)
    sent(hand, TICKING, program=4)
    for program, line in ((3, COUNT), (3, CALL), (4, 30)):
        hand.do("break.set", program=program, line=line)

    def left() -> list[tuple[int, int]]:
        return [(each["program"], each["line"]) for each in fact(hand)["breakpoints"]]

    assert left() == [(3, COUNT), (3, CALL), (4, 30)]
    hand.do("break.clear", program=3, line=CALL)
    assert left() == [(3, COUNT), (4, 30)]
    hand.do("break.clear", program=3)
    assert left() == [(4, 30)]
    hand.do("break.set", program=3, line=COUNT)
    hand.do("break.clear")
    assert left() == []
    hand.do("card.run", program=3)
    hand.until(lambda: card(hand).p[10] > 3)


def test_the_history_shows_the_hold_again_and_nothing_is_held_in_the_past(
    running: HandStation,
) -> None:
    hand, begin = running, card(running).lived_tk
    hand.do("card.go", program=3)
    hand.until(lambda: card(hand).p[10] == 1 and held(hand) == [(3, COUNT)])
    hand.do("timeline.pause")
    end = card(hand).lived_tk
    hand.do("timeline.seek", tick=begin)
    assert card(hand).p[10] == 0
    hand.do("timeline.seek", tick=end)  # lives through the hold again
    assert card(hand).p[10] == 1
    assert held(hand) == [(3, COUNT)]
    state = card(hand).digest()
    hand.do("timeline.seek", tick=begin)
    hand.do("timeline.run", speed=1.0)
    hand.until(lambda: card(hand).lived_tk >= end)
    assert len(hand.events("timeline")[-1]["branches"]) == 1
    hand.do("timeline.seek", tick=end)
    assert card(hand).digest() == state
    assert len(hand.events("timeline")[-1]["branches"]) == 1


def test_a_tick_by_hand_holds_a_program_too(hand: HandStation) -> None:
    sent(hand, TICKING, program=4)
    hand.do("card.run", program=4)
    hand.do("break.set", program=4, line=30)
    hand.do("timeline.pause")
    for _ in range(40):
        hand.do("timeline.step", what="tick")
    count = card(hand).p[20]
    for _ in range(40):
        hand.do("timeline.step", what="tick")
    assert card(hand).p[20] == count
    assert held(hand) == [(4, 30)]


def test_other_programs_with_breakpoints_do_not_hold_a_released_program_at_its_line_again(
    running: HandStation,
) -> None:
    hand, values = running, card(running).p
    hand.do("break.set", program=4, line=30, condition="0")
    hand.run(0.1)
    first = fact(hand)["held"][0]["hit"]
    hand.do("card.go", program=3)
    hand.until(lambda: held(hand) == [(3, COUNT)] and fact(hand)["held"][0]["hit"] > first)
    assert values[10] == 1


def test_block_mode_and_its_step_are_not_held_a_second_time_at_a_breakpoint(
    running: HandStation,
) -> None:
    hand, values = running, card(running).p
    hand.do("break.set", program=3, line=AFTER)
    hand.do("card.block", program=3, on=True)
    hand.do("card.resume", program=3)
    hand.run(0.2)
    for _ in range(6):
        hand.do("card.step", program=3)
        hand.run(0.2)
    assert (values[10], values[11], values[12]) == (1, 1, 1)
    states = {each["name"]: each["state"] for each in read_states(hand.station.link.read)}
    assert states["PROG3"] == "waits for STEP"
    hand.do("card.go", program=3)
    hand.until(lambda: values[10] == 1 and held(hand) == [(3, COUNT)])


def test_a_traced_program_is_held_before_the_line_too(running: HandStation) -> None:
    hand, values = running, card(running).p
    card(hand).send("TRON PROG3\r")
    hand.do("card.go", program=3)
    hand.until(lambda: values[12] == 1 and held(hand) == [(3, COUNT)])
    assert values[10] == 1
    hand.do("card.go", program=3)
    hand.until(lambda: values[12] == 2 and held(hand) == [(3, COUNT)])
    assert values[10] == 2


def test_a_program_that_is_halted_at_its_first_line_and_started_again_is_held_there_again(
    hand: HandStation,
) -> None:
    sent(hand, "PROGRAM\nP10 = P10+1\nDWL 0.05\nENDP\n")
    hand.do("break.set", program=3, line=20)
    for _ in range(2):
        hand.do("card.run", program=3)
        stopped(hand, 20)
        hand.do("card.halt", program=3)
        hand.until(lambda: held(hand) == [])
    assert card(hand).p[10] == 0


def test_a_card_over_a_link_has_no_breakpoints_and_says_what_it_has(tmp_path: Path) -> None:
    store = Store()
    on_card = OnCard(Installation.at("127.0.0.1:1", store, tmp_path), lambda _event: None)
    assert on_card.breakpoints() == {"why_not": NO_BREAKPOINTS, "breakpoints": [], "held": []}
    with pytest.raises(UserError, match="PAUSE holds a program, BLOCK and STEP carry it out"):
        on_card.stops.clear()
    store.close()
