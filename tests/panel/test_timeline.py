"""The timeline of the panel: time that is still, fast, slow or runs back, and its branches."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from tests.controller.hosts import X_AND_Y, connected
from tests.network.rig import DI, DO, node
from tests.network.rig import running as running_nodes
from tests.network.rig import start as start_network
from tests.panel.bench import LIMIT_S, HandStation, Served

from openacr.channels import StreamKind
from openacr.client import Level
from openacr.client.program_variables import variables
from openacr.controller import Controller
from openacr.controller.changes import MOVED, Changes
from openacr.controller.journal import read_journal
from openacr.controller.replay import Replay
from openacr.debugger.calls import is_running
from openacr.errors import UserError
from openacr.journal.entries import Entered, JournalEntry
from openacr.map.rows import axes
from openacr.map.words import af1, mf1
from openacr.mill.card.alarms import PROGRAM_ERROR
from openacr.panel.control.engineer.conversations import answer_of
from openacr.panel.control.engineer.scope import Samples
from openacr.panel.control.engineer.watches import Wish
from openacr.panel.control.machine.alarm_log import MOST as MOST_ALARMS
from openacr.panel.control.machine.alarm_log import Alarmed, AlarmLog
from openacr.panel.control.machine.blocks import MOST as MOST_BLOCKS
from openacr.panel.control.machine.blocks import Block, Blocks, part_lanes
from openacr.panel.control.machine.history import AWAY, MOST_BRANCHES, STILL, History
from openacr.panel.control.machine.lanes import (
    MOST_CHANGES,
    PART_CHANGES,
    Course,
    Logged,
)
from openacr.panel.control.machine.traffic import MOST, Sent, arrived, traffic
from openacr.panel.control.station import Station
from openacr.panel.control.times import Times, step_move
from openacr.protocol.events import ControlKey
from openacr.sysvar.tabs import OFFSETS
from openacr.timeline import Kind

LINES = ("10 P0=P0+1", "20 DWL 0.01", "30 GOTO 10")


@pytest.fixture
def hand(tmp_path: Path) -> Iterator[HandStation]:
    """A station whose card counts in P0 every 10 ms."""
    station = HandStation(tmp_path)
    yield station
    station.close()


def history(hand: HandStation) -> History:
    return hand.station.times.history


def times(hand: HandStation) -> Times:
    return hand.station.times


def fact(hand: HandStation, name: str) -> dict[str, object]:
    hand.station.facts.tell()
    return dict(hand.station.facts.reported[name])


def count(hand: HandStation) -> None:
    """Have program 5 count in P0."""
    for line in LINES:
        hand.station.link.machine.card.command(line, program=5)
    hand.station.link.machine.card.command("RUN", program=5)


def test_time_is_still_in_a_pause_and_goes_on_at_run(hand: HandStation) -> None:
    count(hand)
    hand.run(0.5)
    hand.do("timeline.pause")
    tick, digest = history(hand).lived_tk, history(hand).card.digest()
    hand.run(5.0)
    assert history(hand).lived_tk == tick
    assert history(hand).card.digest() == digest
    assert fact(hand, "timeline")["still"] is True
    assert fact(hand, "moment")["tick"] == tick
    assert hand.refused("mdi.execute", line="G0 X1")["text"] == STILL
    assert hand.refused("memory.read")["text"] == STILL
    hand.do("timeline.run")
    hand.run(1.0)
    assert (history(hand).lived_tk - tick) * history(hand).period_s == pytest.approx(1.0, abs=0.02)
    assert hand.station.link.lost == ""
    assert not hand.station.link.machine.runner.is_out_of_reach  # no watchdog has tripped
    assert hand.station.link.machine.runner.alarms.active == []


@pytest.mark.parametrize(("speed", "time_s"), [(0.01, 8.0), (0.1, 4.0), (4.0, 1.5)])
def test_time_passes_as_fast_as_is_asked(hand: HandStation, speed: float, time_s: float) -> None:
    hand.do("timeline.run", speed=speed)
    hand.run(1.0)
    begin = history(hand).lived_tk
    hand.run(time_s)
    passed_s = (history(hand).lived_tk - begin) * history(hand).period_s
    assert passed_s == pytest.approx(time_s * speed, rel=0.02, abs=0.03)
    assert hand.now_s - hand.station.snapshot.read_s < 0.1


def test_as_fast_as_it_goes_every_step_lets_a_burst_pass(hand: HandStation) -> None:
    hand.do("timeline.run", speed=None)
    begin = history(hand).lived_tk
    hand.run(0.2)
    assert (history(hand).lived_tk - begin) * history(hand).period_s >= 1.0


@pytest.mark.parametrize("speed", [0.0099, 100.1, 0.0, -1.0])
def test_another_speed_is_refused(hand: HandStation, speed: float) -> None:
    answer = hand.refused("timeline.run", speed=speed)
    assert answer["text"] == f"speed {speed:g}: 0.01 to 100, or as fast as it goes"


def test_a_moment_shown_again_is_the_card_it_was_to_the_bit_and_so_is_what_follows(
    hand: HandStation,
) -> None:
    count(hand)
    card, digests = history(hand).card, {}
    for _ in range(8):
        hand.run(0.1)
        digests[card.lived_tk] = card.digest()
    hand.run(0.1)
    ticks = list(digests)
    for tick in (ticks[3], ticks[6], ticks[0]):
        hand.do("timeline.seek", tick=tick)
        assert (card.lived_tk, card.digest()) == (tick, digests[tick])
    for tick in ticks[1:]:  # and forward, tick for tick where inputs came
        history(hand).is_still = False
        history(hand).advance(tick - card.lived_tk)
        assert card.digest() == digests[tick]
    assert len(history(hand).timeline.branches) == 1


def test_screens_show_the_moment_and_move_nothing_until_the_machine_is_operated_from_it(
    hand: HandStation,
) -> None:
    hand.do("watch.begin", topic="watch", parameters=["P0"], hz=20)
    shown: list[float] = []
    hand.station.watches.report = lambda _wish, _numbers, changed: shown.append(changed[0][1])
    count(hand)
    hand.run(1.0)
    tick, value = history(hand).lived_tk, history(hand).card.p[0]
    hand.run(1.0)
    hand.do("timeline.seek", tick=tick)
    hand.run(0.3)
    assert shown[-1] == value
    assert shown[-2] > value
    assert history(hand).lived_tk == tick
    assert hand.station.link.lost == AWAY
    assert hand.now_s - hand.station.snapshot.read_s < 0.1
    state = fact(hand, "state")
    assert (state["reason"], state["link"]) == ("", "ok")
    assert fact(hand, "alarms") == {
        "active": [], "history": [], "bars_start": True,
    }  # fmt: skip
    assert AWAY in hand.refused("mdi.execute", line="G0 X1")["text"]
    assert AWAY in hand.refused("term.open")["text"]
    hand.do("timeline.operate")
    assert hand.station.link.lost == ""
    assert [each.number for each in history(hand).timeline.branches] == [0, 1]
    parent, branch = history(hand).timeline.branches
    assert branch.fork is not None
    assert (branch.parent, branch.fork.tick) == (0, tick)
    assert parent.last.tick > tick
    before = history(hand).card.p[0]
    hand.run(1.0)
    assert history(hand).card.p[0] > before
    assert hand.station.link.machine.runner.alarms.active == []


def test_moves_of_the_panel_are_held_where_it_is_operated_from_and_no_alarm_comes(
    hand: HandStation,
) -> None:
    hand.do("mdi.execute", line="G21 G91 G1 X50 F600")
    hand.run(1.0)
    tick = history(hand).lived_tk
    assert hand.station.snapshot.speed_upm > 0.0
    hand.do("stop.all")
    hand.until(lambda: not hand.is_busy)
    hand.do("timeline.seek", tick=tick)
    begun = history(hand).card.p[12288]
    hand.do("timeline.operate")
    place = history(hand).card.p[12288]
    (axis, *_others) = hand.station.link.machine.runner.settings.axes
    assert 0 < place - begun < axis.pulses_per_unit  # until it rests, less than 1 mm
    hand.run(3.0)  # longer than the watchdog waits for its host
    assert hand.station.link.machine.runner.alarms.raised == 0
    assert history(hand).card.p[12288] == place
    hand.do("mdi.execute", line="G21 G91 G1 X1 F600")
    hand.until(lambda: not hand.is_busy)


def test_what_is_recorded_runs_again_up_to_its_end_and_is_still_there(hand: HandStation) -> None:
    count(hand)
    hand.run(1.0)
    tick = history(hand).lived_tk
    hand.run(0.5)
    hand.do("timeline.seek", tick=tick)
    last, digest = history(hand).timeline.branch.last, None
    history(hand).timeline.seek(last)
    digest = history(hand).card.digest()
    hand.do("timeline.seek", tick=tick)
    hand.do("timeline.run", speed=10.0)
    hand.until(lambda: history(hand).is_still)
    assert history(hand).timeline.now == last
    assert history(hand).card.digest() == digest
    assert len(history(hand).timeline.branches) == 1
    hand.do("timeline.run", speed=1.0)  # and beyond, without the panel
    hand.run(0.5)
    assert history(hand).lived_tk > last.tick
    assert not history(hand).is_still


def test_a_value_set_in_the_past_begins_a_branch_and_both_can_be_compared(
    hand: HandStation,
) -> None:
    count(hand)
    hand.run(1.0)
    tick, value = history(hand).lived_tk, history(hand).card.p[0]
    hand.run(0.5)
    hand.do("timeline.seek", tick=tick)
    assert hand.do("card.write", parameter=0, value=500.0) == {"value": 500.0}
    assert history(hand).timeline.branch.number == 1
    at_s = tick * history(hand).period_s
    assert hand.said[-1] == f"branch 1 begins at {at_s:.4g} s: first keeps the rest"
    hand.do("timeline.run", speed=1.0)
    hand.run(0.5)
    timeline = history(hand).timeline
    channels = [timeline.course(n, tick).samples([0], tick, 100, 9)[0] for n in (0, 1)]
    assert channels[0][0] == value
    assert [b - a for a, b in zip(*channels, strict=True)] == [500.0 - value] * 9
    values = [timeline.course(n, tick + 400, tick + 400).values([0], tick + 400) for n in (0, 1)]
    assert values == [[channels[0][4]], [channels[1][4]]]
    hand.do("timeline.switch", number=0, tick=tick)
    assert (history(hand).card.p[0], timeline.branch.number) == (value, 0)
    assert hand.refused("timeline.switch", number=7)["text"] == "there is no branch 7; known: 0, 1"
    hand.do("timeline.forget", number=1)
    assert hand.refused("timeline.forget", number=0)["text"] == (
        "branch 0 is the present one: change to another one first"
    )


def test_what_is_asked_of_a_moment_is_answered_by_a_copy_at_its_statement(
    hand: HandStation,
) -> None:
    hand.station.link.machine.card.command("DIM LV(1)", program=5)
    hand.station.link.machine.card.download(
        "10 LV0=LV0+1\n20 P0=LV0\n30 GOTO 10\n", to=Level.program(5)
    )
    hand.station.link.machine.card.command("RUN", program=5)
    hand.run(0.5)
    tick = history(hand).lived_tk - 500
    hand.do("timeline.seek", tick=tick)
    counts, written = [], []
    for _ in range(6):  # lines 10, 20 and 30 in turn, within one tick
        hand.do("timeline.step", what="line", number=5)
        assert history(hand).card.within
        digest = history(hand).card.digest()
        found = answer_of(history(hand).moment(), lambda talk: variables(talk, 5))
        assert (len(found), found[0].name) == (1, "LV0")
        counts.append(int(found[0].text))
        written.append(int(history(hand).card.p[0]))
        assert history(hand).card.digest() == digest  # nothing of the card that is shown
    assert counts[3:] == [each + 1 for each in counts[:3]]
    assert sorted(b - a for a, b in zip(written, counts, strict=True)) == [0, 0, 0, 0, 1, 1]


def test_a_branch_begun_without_a_change_goes_on_as_the_first_without_its_inputs(
    hand: HandStation,
) -> None:
    assert hand.refused("timeline.branch")["text"] == (
        "nothing follows here: go back to a moment first"
    )
    hand.run(0.5)
    tick = history(hand).lived_tk
    hand.run(0.5)
    hand.do("timeline.seek", tick=tick)
    assert hand.do("timeline.branch") == {"number": 1}
    assert not history(hand).timeline.is_past
    hand.do("timeline.name", number=1, name="what if")
    branches = fact(hand, "timeline")["branches"]
    assert [(b["number"], b["name"], b["fork"]) for b in branches] == [  # type: ignore[attr-defined]
        (0, "first", None),
        (1, "what if", tick),
    ]


def test_of_too_many_branches_the_oldest_is_forgotten(hand: HandStation) -> None:
    hand.run(0.1)
    hand.do("timeline.seek", tick=history(hand).lived_tk)
    for _ in range(MOST_BRANCHES + 3):
        hand.do("timeline.step", what="tick")
        hand.do("timeline.step", what="back")
        hand.do("timeline.branch")
    numbers = [each.number for each in history(hand).timeline.branches]
    assert numbers == list(range(4, 4 + MOST_BRANCHES))
    assert sorted(history(hand).names) == numbers


def test_a_step_is_one_tick_one_line_or_one_move(hand: HandStation) -> None:
    card = history(hand).card
    count(hand)
    hand.run(0.3)
    hand.do("timeline.pause")
    tick = card.lived_tk
    hand.do("timeline.step")
    assert (card.lived_tk, hand.station.link.is_away) == (tick + 1, False)
    hand.do("timeline.step", what="line", number=5)
    assert (card.within > 0, card.announced_program) == (True, 5)
    line = card.executor.threads.next_line(5)
    for _ in range(3):
        hand.do("timeline.step", what="line", number=5)
    assert card.executor.threads.next_line(5) == line  # once round
    tick = card.lived_tk
    hand.do("timeline.step", what="tick")
    assert (card.lived_tk, card.within) == (tick, 0)
    hand.do("timeline.step", what="back")
    assert card.lived_tk == tick - 1
    assert hand.refused("timeline.step", what="line", number=6)["text"] == (
        "PROG6 does not run: only a running program can step"
    )
    assert hand.refused("timeline.step", what="move", number=0)["text"] == (
        "no move of MASTER0 has begun or ended in 10 s"
    )


@pytest.mark.parametrize(
    ("name", "args"),
    [
        ("timeline.seek", {"tick": 0}),
        ("timeline.switch", {"number": 0}),
        ("timeline.step", {"what": "back"}),
        ("timeline.step", {"what": "line", "number": 5}),
        ("timeline.step", {"what": "move"}),
    ],
)
def test_nothing_goes_to_the_past_while_the_panel_moves_the_machine(
    hand: HandStation, name: str, args: dict[str, Any]
) -> None:
    begin = history(hand).lived_tk
    if "tick" in args:
        args = {"tick": begin}
    hand.do("jog.increment", axis="X", direction=1, distance=2.0, tick=hand.tick)
    hand.run(0.1)
    assert hand.refused(name, **args)["text"] == (
        "the panel moves the machine (state IDLE): wait until it rests, or STOP, then go back"
    )
    assert (hand.station.link.is_away, hand.station.link.is_still) == (False, False)
    hand.until(lambda: not hand.is_busy)
    assert hand.places()[0] == pytest.approx(2.0)


def test_a_stop_ends_a_pause_and_another_speed_and_stops_the_machine(hand: HandStation) -> None:
    hand.do("jog.increment", axis="X", direction=1, distance=50.0, tick=hand.tick)
    hand.run(0.3)
    hand.do("timeline.pause")
    hand.run(1.0)
    hand.do("stop.hold")
    assert (hand.station.link.is_still, times(hand).speed) == (False, 1.0)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.2)
    assert hand.speeds(0.1)[0] == 0.0
    assert hand.places()[0] < 50.0
    hand.do("timeline.run", speed=0.01)
    hand.do("stop.hold")
    assert times(hand).speed == 1.0


def test_a_stop_in_the_past_lets_time_be_still(hand: HandStation) -> None:
    hand.run(0.5)
    hand.do("timeline.seek", tick=history(hand).lived_tk - 500)
    hand.do("timeline.run", speed=0.01)
    for name in ("stop.hold", "stop.all", "stop.estop"):
        history(hand).is_still = False
        hand.do(name)
        assert hand.station.link.is_still


def test_held_keys_end_when_time_becomes_still(hand: HandStation) -> None:
    assert hand.press(1)["ok"]
    hand.keep(1, 0.3)
    hand.do("timeline.pause")
    assert not hand.station.hand_motion.presses.are_held
    hand.do("timeline.run")
    hand.until(lambda: not hand.is_busy)


def test_bookmarks_are_set_at_the_tick_in_which_programs_end_and_errors_come(
    hand: HandStation,
) -> None:
    card = hand.station.link.machine.card
    for number, lines in ((5, ("10 DWL 0.05",)), (6, ("10 DWL 0.02", "20 P999999=1"))):
        for line in lines:
            card.command(line, program=number)
        card.command("RUN", program=number)
    hand.run(0.5)
    hand.do("timeline.mark", text="by hand")
    marks = history(hand).bookmarks.of(0)
    assert [(each.kind.value, each.text.partition(":")[0]) for each in marks] == [
        ("error", "PROG6"),
        ("end", "PROG5 has ended"),
        ("hand", "by hand"),
    ]
    for each, program in zip(marks, (6, 5), strict=False):
        for tick, runs in ((each.tick - 1, True), (each.tick, False)):
            hand.do("timeline.seek", tick=tick)
            assert is_running(history(hand).card, program) is runs
    assert history(hand).bookmarks.of(0) == marks  # the watchdog has ended without one


def lanes(hand: HandStation, branch: int, first: int, last: int) -> dict[tuple[str, int], Any]:
    hidden = history(hand).unmarked
    found = history(hand).lanes.of(branch).lanes(first, last, hidden, near=0)
    return {(each.kind, each.number): each for each in found}


def test_lanes_have_the_ticks_in_which_axes_moved_and_programs_ran(hand: HandStation) -> None:
    start = history(hand).lived_tk
    hand.run(0.5)
    drives = lanes(hand, 0, 0, history(hand).lived_tk)
    assert {kind for kind, _number in drives} <= {"drive"}  # not the panel's own watchdog
    for line in ("10 DWL 0.4", "RUN"):
        hand.station.link.machine.card.command(line, program=5)
    hand.do("jog.increment", axis="Y", direction=1, distance=1.0, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    hand.run(1.0)
    end = history(hand).lived_tk
    found = lanes(hand, 0, start, end)
    assert {key for key in found if key[0] in ("axis", "program")} == {("axis", 1), ("program", 5)}
    (program,) = found["program", 5].spans
    (moved,) = found["axis", 1].spans
    assert found["program", 5].on_tk == program[1] - program[0]
    assert (found["axis", 1].changes, found["program", 5].changes) == (2, 2)
    middle = sum(program) // 2
    part = lanes(hand, 0, middle, middle + 100)["program", 5]
    assert (part.spans, part.on_tk, part.changes) == ([(middle, middle + 100)], 100, 0)
    assert lanes(hand, 0, program[1], end)["program", 5].spans == []

    def commanded_cnt(tick: int) -> float:
        hand.do("timeline.seek", tick=tick)
        return history(hand).card.memory.F[axes.psp_cnt[1]]

    card = history(hand).card
    for tick, runs in zip(program, (True, False), strict=True):
        typed_tk = int(runs)  # it was started between two ticks
        for at, expected in ((tick - 1 - typed_tk, not runs), (tick, runs)):
            hand.do("timeline.seek", tick=at)
            assert is_running(card, 5) is expected
    first, last = moved
    assert commanded_cnt(first - 2) == commanded_cnt(first - 1) != commanded_cnt(first)
    assert commanded_cnt(last - 2) != commanded_cnt(last - 1) == commanded_cnt(last)


def test_a_branch_has_the_lanes_of_what_was_before_it_and_its_own(hand: HandStation) -> None:
    count(hand)
    hand.run(0.5)
    fork = history(hand).lived_tk - 200
    hand.do("timeline.seek", tick=fork)
    before = lanes(hand, 0, 0, history(hand).last_tk)["program", 5].spans
    hand.do("timeline.run", speed=1.0)  # what is lived through again is not noted twice
    hand.until(lambda: history(hand).is_still)
    assert lanes(hand, 0, 0, history(hand).last_tk)["program", 5].spans == before
    assert before[0][1] == history(hand).last_tk
    hand.do("timeline.seek", tick=fork)
    hand.do("timeline.branch")
    history(hand).card.send("PROG5\rHALT\r")
    hand.do("timeline.run", speed=1.0)
    hand.run(0.5)
    ((first, last),) = lanes(hand, 1, 0, history(hand).last_tk)["program", 5].spans
    assert first == before[0][0]
    assert last == fork + 1  # what comes between two ticks is noted at the end of the later one
    for tick, runs in ((fork - 1, True), (fork, False)):
        hand.do("timeline.seek", tick=tick)
        assert is_running(history(hand).card, 5) is runs
    hand.do("timeline.switch", number=0)
    assert lanes(hand, 0, 0, 1 << 40)["program", 5].spans == before
    hand.do("timeline.run", speed=1.0)  # on from the end of that branch
    hand.run(0.3)
    hand.run(0.3)
    assert lanes(hand, 0, 0, 1 << 40)["program", 5].spans == [(before[0][0], history(hand).last_tk)]
    hand.do("timeline.switch", number=1)
    hand.do("timeline.switch", number=0)
    hand.do("timeline.forget", number=1)


def test_inputs_and_outputs_have_lanes_where_they_changed_and_drives_where_they_are_on() -> None:
    host = connected(*X_AND_Y)
    own = History(host.card)
    begin = own.lived_tk
    host.card.set_input(3, True)
    own.advance(10)
    host.card.bit[63] = True  # the last output
    own.advance(10)
    host.card.bit[63] = False
    own.advance(5)
    found = {(each.kind, each.number): each for each in own.lanes.of(0).lanes(begin, own.lived_tk)}
    assert found["input", 3].spans == [(begin + 1, begin + 25)]
    assert found["output", 31].spans == [(begin + 11, begin + 21)]
    assert (found["output", 31].flag, found["input", 3].flag) == (63, 3)
    assert (found["output", 31].on_tk, found["output", 31].changes) == (10, 2)


@pytest.mark.parametrize("mapping", [0, 1])
def test_lines_of_expansion_boards_and_of_nodes_have_lanes_where_they_changed(mapping: int) -> None:
    card = running_nodes(node(1, digital_inputs=12, digital_outputs=40), 1)
    card.p[32771] = mapping  # 1: the first word of the node is that of board 0
    assert start_network(card) == 2
    own = History(card)
    begin = own.lived_tk
    card.set_input(DI[0] + 11, True)
    card.bit[DO[0] + 39] = True
    card.bit[320 + 1], card.bit[480 + 31] = True, True  # an input of board 1, an output of board 3
    own.advance(round(0.2 / card.period_s))
    found = {(each.kind, each.flag): each for each in own.lanes.of(0).lanes(begin, own.lived_tk)}
    lines = {place for place in found if place[0] in ("input", "output")}
    assert lines == {
        ("input", 256 + 11 if mapping else DI[0] + 11),
        ("output", DO[0] + 39),
        ("input", 321),
        ("output", 511),
    }
    assert found["output", DO[0] + 39].number == DO[0] + 39
    assert found["output", 511].spans == [(begin + 1, own.lived_tk)]


def test_no_more_words_are_compared_than_a_card_has() -> None:
    small, large = (Logged.of(Controller(model)) for model in ("ACR9000", "ACR8020"))
    assert (len(small.setpoints), len(large.setpoints)) == (8, 16)
    assert len(small.words) == 8 + 16 + 8 + 8 + 2 + 8
    assert len(large.words) == 16 + 16 + 8 + 16 + 2 + 8
    nodes = Logged.of(running_nodes(node(1, digital_inputs=12, digital_outputs=40), 1))
    assert len(nodes.words) == len(small.words) + 4 + 8  # in each of four places a word, and two


LOGGED = Logged(2, [])


def noted(values: list[tuple[int, int]], word: int = MOVED) -> Changes:
    ticks, states = np.array(values).T
    return Changes(ticks, np.full(len(ticks), word), states)


def course(*values: tuple[int, int], end: int) -> Course:
    own = Course(LOGGED, 0, np.zeros(len(LOGGED.words) + 1, np.int64))
    own.note(noted(list(values)), end)
    return own


def test_spans_that_are_nearer_than_a_thousandth_are_one_but_sums_are_exact() -> None:
    own = course((100, 1), (200, 0), (300, 1), (400, 0), (500, 1), end=600)
    for last, spans in (
        (99_999, [(100, 200), (300, 400), (500, 600)]),
        (100_000, [(100, 600)]),
    ):
        (lane,) = own.lanes(0, last)
        assert (lane.spans, lane.on_tk, lane.changes) == (spans, 300, 5)
    (lane,) = own.lanes(150, 350)
    assert (lane.spans, lane.on_tk, lane.changes) == ([(150, 200), (300, 350)], 100, 2)
    (lane,) = own.lanes(100, 200)
    assert (lane.spans, lane.on_tk, lane.changes) == ([(100, 200)], 100, 1)
    (lane,) = own.lanes(100, 199)  # the change in the first tick was before
    assert (lane.spans, lane.on_tk, lane.changes) == ([(100, 199)], 99, 0)
    (lane,) = own.lanes(200, 300)
    assert (lane.spans, lane.on_tk, lane.changes) == ([], 0, 1)
    own.note(noted([(550, 0), (600, 0), (700, 0), (800, 1)]), 900)  # what is known comes again
    (lane,) = own.lanes(0, 5000)
    assert lane.spans == [(100, 200), (300, 400), (500, 700), (800, 900)]
    (lane,) = own.until(300).lanes(0, 5000)
    assert lane.spans == [(100, 200)]
    assert own.until(301).lanes(0, 5000)[0].spans == [(100, 200), (300, 301)]


def test_of_too_many_changes_the_oldest_are_forgotten_and_what_was_on_then_is_known() -> None:
    own = course((10, 3), end=10)
    for part in range(0, MOST_CHANGES + 20_000, 1000):
        ticks = range(part + 11, part + 1011)
        own.note(noted([(tick, 2 + tick % 2) for tick in ticks]), part + 1010)
    kept = len(own.changes.ticks)
    assert MOST_CHANGES - PART_CHANGES <= kept <= MOST_CHANGES + PART_CHANGES
    x, y = own.lanes(0, own.end, near=0)
    assert own.first > 10
    assert y.spans == [(own.first, own.end)]  # on all the time
    assert x.spans[0][0] in (own.first, own.first + 1)
    assert own.size_bytes < 24 * kept + 24


def test_traffic_is_packets_and_lines_of_each_stream() -> None:
    came = [
        JournalEntry(10, Entered.BYTES, 2, "X1\rY2\r"),
        JournalEntry(12, Entered.BYTES, 2, "\0\x02\r\r"),
        JournalEntry(11, Entered.BYTES, 5, "V"),
        JournalEntry(40, Entered.BYTES, 2, "Z\r"),
    ]
    first, second = traffic(arrived(came), 2)
    assert first == (2, [(10, 13), (40, 41)], 1, 3, 12)
    assert second == (5, [(11, 12)], 0, 0, 1)


def sums(own: History, branch: int, first: int = 0) -> list[tuple[int, ...]]:
    """Stream, packets, lines and bytes of what the card has sent on a branch."""
    found = traffic(own.sent.between(branch, first, 1 << 40), 0)
    return [(each.stream, each.packets, each.lines, each.size_bytes) for each in found]


def test_what_the_card_sends_is_known_to_the_tick_and_once_however_often_it_is_lived_through() -> (
    None
):
    host = connected(*X_AND_Y)
    own = History(host.card)
    stream = host.stream
    host.type("PROG1", "10 DWL 0.1", '20 PRINT "five"', "PROG0")
    begin = own.lived_tk
    before = sums(own, 0)
    own.receive(stream, b"PROG1\rLRUN\r")
    own.advance(3000)
    host.heard()
    own.receive(stream, bytes.fromhex("00 88 01 10"))
    ((_stream, _packets, lines, size),) = before or [(stream, 0, 0, 0)]
    known = sums(own, 0)
    ((at, packets, more, longer),) = known
    assert (at, packets) == (stream, 1)
    assert more - lines >= 3  # echoes of two lines, what PRINT says
    assert longer > size
    (first, *_rest, last) = own.sent.between(0, begin, own.lived_tk).ticks.tolist()
    assert (first, last) == (begin, begin + 3000)
    printed = own.sent.between(0, begin + 1, begin + 2999)
    program = own.lanes.of(0).lanes(begin, own.lived_tk)[0]
    assert (program.kind, program.spans) == ("program", [(begin + 1, printed.ticks[0])])
    assert printed.sizes.tolist() == [len("five\r\n"), len("P01>")]
    end = own.lived_tk
    own.timeline.seek(begin + 10)
    own.advance(end - own.lived_tk)
    own.advance(0)
    assert sums(own, 0) == known
    own.timeline.seek(begin + 10)
    own.receive(stream, b"VER\r")  # begins a branch, without what followed
    assert own.timeline.branch.number == 1
    ((_at, packets, lines, _size),) = sums(own, 1, begin + 10)
    assert (packets, lines) == (0, 1)  # its echo: the stream follows the program
    kept = own.sent.between(1, begin, begin + 9).sizes.tolist()
    assert kept == own.sent.between(0, begin, begin + 9).sizes.tolist() != []
    assert sums(own, 0) == known
    own.timeline.switch(0)
    own.forget(1)
    assert (sums(own, 1), sums(own, 0)) == ([], known)


def test_of_too_much_that_was_sent_the_older_half_is_forgotten() -> None:
    sent = Sent()
    for tick in range(MOST + 1):
        sent.note(0, tick, 1, b"a", False)
    ticks = sent.between(0, 0, MOST).ticks
    assert (len(ticks), ticks[0], ticks[-1]) == (MOST // 2 + 1, MOST // 2, MOST)
    assert sent.size_bytes == 20 * len(ticks)
    assert len(sent.between(0, MOST - 3, MOST - 1).ticks) == 3
    sent.fork(0, 1, MOST - 1)
    assert sent.between(1, 0, MOST).ticks.tolist() == ticks[:-1].tolist()


def test_a_branch_is_saved_as_a_journal_that_replays_to_equal_digests(
    hand: HandStation, tmp_path: Path
) -> None:
    count(hand)
    hand.run(1.0)
    hand.do("timeline.seek", tick=history(hand).lived_tk)
    path = tmp_path / "branch.journal"
    history(hand).timeline.course(0).save(path)
    replay = Replay(read_journal(path))
    replay.run()
    assert replay.card.digest() == history(hand).card.digest()


def test_the_end_of_a_part_program_is_marked_when_the_panel_notes_it(hand: HandStation) -> None:
    (hand.installation.programs / "short.nc").write_text("G4 P0.1\nM2\n")
    hand.do("program.load", path="short.nc")
    hand.do("run.begin")
    hand.until(lambda: hand.is_busy)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    (mark,) = history(hand).bookmarks.of(0)
    assert (mark.kind.value, mark.text) == ("end", "short.nc has ended")


def test_the_block_of_a_part_program_is_known_at_a_moment_and_the_program_starts_there(
    hand: HandStation,
) -> None:
    lines = ["G1 X4 F1200", "G1 Y4", "G1 X0", "G1 Y0", "G4 P0.5", "M2"]
    (hand.installation.programs / "square.nc").write_text("\n".join(lines) + "\n")
    hand.do("program.load", path="square.nc")
    hand.do("run.begin")
    seen = {}
    hand.until(lambda: hand.station.part.line > 0)
    while hand.is_busy:
        hand.run(0.05)
        seen[history(hand).lived_tk] = hand.station.part.line
    hand.run(0.1)
    end = hand.places()
    assert fact(hand, "moment")["block"] is None  # it is not a moment
    at = next(tick for tick, line in seen.items() if line == 3)
    hand.do("timeline.seek", tick=at)
    assert fact(hand, "moment")["block"] == {"path": "square.nc", "line": 3}
    (lane,) = part_lanes(
        history(hand).blocks.between(0, 0, at + 1), 0, at + 1, history(hand).last_tk, 0
    )
    assert [line for _tick, line in lane["slices"]] == [1, 2, 3]  # type: ignore[attr-defined]
    assert lane["spans"][-1][1] == at + 1  # type: ignore[index]
    hand.do("timeline.seek", tick=10)
    assert fact(hand, "moment")["block"] is None
    hand.do("timeline.seek", tick=at)
    assert hand.do("timeline.operate") == {"tick": at}
    hand.run(0.2)
    branch = history(hand).timeline.branch.number
    assert history(hand).blocks.at(branch, at + 1) is None  # it has ended there
    before = hand.places()
    answer = hand.do("run.begin", line=3, safe_z=0.0)
    assert hand.places() == before  # nothing moves before it is confirmed
    hand.do("run.begin", line=3, safe_z=0.0, confirm=answer["rehearsal"]["token"])
    hand.until(lambda: hand.is_busy)
    hand.until(lambda: not hand.is_busy)
    assert hand.places()[:2] == pytest.approx(end[:2])


def test_blocks_are_noted_once_thinned_from_their_beginning_and_shared_up_to_a_fork() -> None:
    blocks = Blocks()
    for tick, line in ((10, 1), (12, 1), (15, 2), (20, 0), (30, 7)):
        blocks.note(0, Block(tick, "a.nc", line))
    blocks.note(0, Block(25, "a.nc", 9))  # known time, lived through again
    assert [blocks.at(0, tick) and blocks.at(0, tick).line for tick in (9, 10, 14, 15, 20, 30)] == [  # type: ignore[union-attr]
        None, 1, 1, 2, None, 7,
    ]  # fmt: skip
    blocks.fork(0, 1, 16)
    assert [blocks.at(1, 16), blocks.at(1, 17)] == [Block(15, "a.nc", 2), None]
    blocks.note(0, Block(30, "a.nc", 8))
    assert blocks.at(0, 30) == Block(30, "a.nc", 7)  # one block a tick
    blocks.fork(0, 3, 15)
    assert blocks.at(3, 15) == Block(15, "a.nc", 2)
    blocks.fork(0, 2, 9)
    assert blocks.at(2, 100) is None
    assert [each.tick for each in blocks.between(0, 16, 30)] == [15, 20, 30]
    (lane,) = part_lanes(blocks.between(0, 12, 35), 12, 35, 32, 0)
    assert (lane["spans"], lane["on"]) == ([(12, 20), (30, 32)], 10)
    assert lane["slices"] == [(12, 1), (15, 2), (30, 7)]
    for tick in range(100, 100 + MOST_BLOCKS):
        blocks.note(0, Block(tick, "a.nc", tick))
    assert blocks.at(0, 15) is None
    assert blocks.at(0, 99 + MOST_BLOCKS) == Block(99 + MOST_BLOCKS, "a.nc", 99 + MOST_BLOCKS)
    blocks.forget(0)
    assert blocks.at(0, 200) is None


def test_a_bridge_is_given_nothing_of_the_past(hand: HandStation) -> None:
    count(hand)
    given: list[float] = []
    hand.station.watches.begin(
        Wish(-1, "bridge"), [0], 50.0, lambda _wish, _numbers, changed: given.append(changed[0][1])
    )
    hand.run(0.5)
    assert given
    given.clear()
    hand.do("timeline.seek", tick=history(hand).lived_tk - 500)
    given.clear()
    hand.do("timeline.run")
    hand.run(0.5)
    assert given == []
    hand.do("timeline.operate")
    hand.run(0.2)
    assert given


def test_a_step_of_a_move_ends_in_the_tick_in_which_one_begins_or_ends() -> None:
    host = connected(*X_AND_Y)
    history = History(host.card)
    host.send("X1\rX3\r")

    def now() -> tuple[bool, bool]:
        """Whether the master moves, and whether the first move is over."""
        moving = bool(int(history.card.p[mf1.word[0]]) & mf1.IN_MOTION)
        return moving, history.card.axis(0).commanded_u >= 1.0

    assert now() == (True, False)
    for before, there in (((True, False), (True, True)), ((True, True), (False, True))):
        step_move(history, 0)
        tick = history.lived_tk
        assert now() == there
        history.timeline.seek(tick - 1)
        assert now() == before
        history.timeline.seek(tick)
    assert history.card.axis(0).commanded_u == 3.0
    with pytest.raises(UserError, match="no move of MASTER0 has begun or ended in 10 s"):
        step_move(history, 0)


def test_memory_is_bounded_and_the_history_then_begins_later() -> None:
    card = Controller()
    history = History(card, most_bytes=6_000)
    for _ in range(60):
        card.set_input(3, not card.bit[3])
        history.advance(round(2.0 / card.period_s))
    assert history.timeline.size_bytes <= 6_000
    branch = history.timeline.branch
    assert branch.first.tick > 0
    history.timeline.seek(branch.first)
    history.timeline.seek(branch.last)


def test_alarms_of_a_moment_are_those_that_were_active_then(hand: HandStation) -> None:
    alarms = hand.station.link.machine.runner.alarms
    ticks = []
    for act in (
        lambda: None,
        lambda: alarms.raise_alarm(PROGRAM_ERROR, "first", 0.0),
        lambda: alarms.raise_alarm(PROGRAM_ERROR, "second", 0.0),
        lambda: alarms.acknowledge(lambda each: each.detail == "first"),
    ):
        act()
        hand.run(0.1)
        ticks.append(history(hand).lived_tk)

    def shown(tick: int) -> tuple[list[str], list[str]]:
        hand.do("timeline.seek", tick=tick)
        found: Any = fact(hand, "moment")["alarms"]
        texts = ([each["text"] for each in found[key]] for key in ("active", "history"))
        first, second = ([text.split()[-1] for text in part] for part in texts)
        return first, second

    assert fact(hand, "moment")["alarms"] is None  # of the present: those of the session
    known = [([], []), (["first"], ["first"]), (["first", "second"],) * 2]
    known.append((["second"], ["first", "second"]))
    assert [shown(tick) for tick in ticks] == known
    hand.do("timeline.seek", tick=ticks[1])
    hand.do("timeline.branch")
    assert shown(ticks[1]) == known[1]
    hand.do("timeline.switch", number=0)
    assert shown(ticks[3]) == known[3]
    hand.do("timeline.forget", number=1)


def test_of_too_many_alarms_the_older_half_is_forgotten() -> None:
    log = AlarmLog()
    for tick in range(MOST_ALARMS + 1):
        log.note(0, Alarmed(tick, [{"code": tick}], []))
    assert log.shown(0, MOST_ALARMS // 2 - 1) == {"active": [], "history": []}
    assert log.shown(0, MOST_ALARMS // 2)["active"] == [{"code": MOST_ALARMS // 2}]
    log.fork(0, 1, MOST_ALARMS - 1)
    assert log.shown(1, MOST_ALARMS)["active"] == [{"code": MOST_ALARMS - 1}]
    log.forget(1)
    assert log.shown(1, MOST_ALARMS)["active"] == []


def test_an_error_of_a_motion_kill_is_marked_as_an_alarm() -> None:
    host = connected(*X_AND_Y)
    history = History(host.card)
    host.send("X100\r")
    history.advance(100)
    host.card.press(ControlKey.CTRL_X)
    history.advance(10)
    marks = [each for each in history.bookmarks.of(0) if each.kind is Kind.ALARM]
    assert [(each.tick, each.text) for each in marks[:1]] == [
        (marks[0].tick, "the motion of MASTER0 is killed")
    ]
    history.timeline.seek(marks[0].tick)
    assert int(history.card.p[mf1.word[0]]) & mf1.KILL_ALL_MOVES_REQUEST
    history.timeline.seek(marks[0].tick - 1)
    assert not int(history.card.p[mf1.word[0]]) & mf1.KILL_ALL_MOVES_REQUEST


@pytest.mark.parametrize("period_ms", [0.5, 2.0])
def test_samples_of_the_scope_are_those_of_the_history_at_their_ticks(
    hand: HandStation, period_ms: float
) -> None:
    hand.do("jog.increment", axis="X", direction=1, distance=5.0, tick=hand.tick)
    hand.run(0.1)
    armed = hand.do(
        "scope.arm", channels=["P12290", "P6916", "BIT81"], period_ms=period_ms, samples=100
    )
    taken: list[Samples] = []
    hand.station.on_samples = lambda _to, each: taken.append(each)
    hand.run(0.2)
    first, block, _period_s = taken[0]
    every_tk = round(period_ms / 1000.0 / history(hand).period_s)
    course = history(hand).timeline.course(0, armed["tick"], history(hand).lived_tk)
    rows = course.samples([12290, 6916, 4098], armed["tick"], every_tk, block.shape[1])
    assert first == armed["first"]
    assert block[:2].tolist() == rows[:2]
    assert block[2].tolist() == [float(int(word) >> 17 & 1) for word in rows[2]]
    assert len({*block[0]}) > 1


def test_samples_differences_and_a_journal_come_over_http(quiet_panel: Served) -> None:
    def change(station: Station) -> int:
        tick = station.times.history.lived_tk - 1000
        station.times.seek(tick)
        station.times.write(1, 7.0, is_flag=False)
        station.times.history.timeline.advance(400)
        return tick

    quiet_panel.step(1.0)
    tick = quiet_panel.call(change)
    end_s = quiet_panel.call(lambda at: f"{(tick + 400) * at.times.history.period_s:.4g}")
    futures = ThreadPoolExecutor(1)
    with httpx.Client(base_url=f"{quiet_panel.url}/api/timeline", timeout=LIMIT_S) as web:

        def get(path: str, **query: Any) -> httpx.Response:
            asked = futures.submit(web.get, path, params=query)
            while not wait((asked,), 0.005).done:
                quiet_panel.step(0.002)
            return asked.result()

        query = {"parameters": "P1", "first": tick, "last": tick + 400, "count": 5}
        for branch, value in ((0, 0.0), (1, 7.0)):
            assert get("/samples", branch=branch, **query).json() == {
                "first": tick,
                "every": 100,
                "names": ["P1"],
                "channels": [[value] * 5],
            }
        for names in ("P1, BIT81", "p1;bit81", " P1 ,; BIT81,"):
            several = get("/samples", branch=0, **{**query, "parameters": names}).json()
            assert (several["names"], len(several["channels"])) == (["P1", "BIT81"], 2)
        drawn = get("/lanes", branch=0, first=0, last=tick).json()
        assert {each["kind"] for each in drawn["lanes"]} <= {"drive"}
        for direction in ("hosts", "sent"):
            assert [sorted(each) for each in drawn[direction][:1]] == [
                ["is_own", "lines", "packets", "size_bytes", "spans", "stream"]
            ]
            assert [each["is_own"] for each in drawn[direction]] == [True]  # of the bench
        found = get("/differences", branch=0, other=1, tick=tick).json()
        assert found == {
            "count": 1,
            "differences": [
                {"number": 1, "name": found["differences"][0]["name"], "values": [0, 7]}
            ],
        }
        same = get("/first-difference", branch=0, other=1).json()["error"]["text"]
        assert same == f"branches 0 and 1 do the same from their first different input to {end_s} s"
        quiet_panel.call(lambda station: station.times.write(37, 1.0, is_flag=True))
        quiet_panel.call(lambda station: station.times.history.timeline.advance(10))
        differ = get("/first-difference", branch=1, other=0).json()
        at = {"tick": tick + 401, "number": 5, "values": [1, 0], "name": "OUT 37"}
        assert differ == {"apart": tick, "differences": [{"kind": "output", **at}]}
        same = get("/first-difference", branch=0, other=0).json()["error"]["text"]
        assert same == "branches 0 and 0 do the same as far as both are known"
        for wrong, text in (
            (
                {"parameters": ";".join(f"P{n}" for n in range(9))},
                "9 parameters: 1 to 8 are sampled",
            ),
            ({"parameters": ""}, "0 parameters: 1 to 8 are sampled"),
            ({"last": tick}, "an interval of 0 ticks: 1 to 1000000 are sampled"),
        ):
            answer = get("/samples", branch=0, **{**query, **wrong})
            assert answer.json()["error"]["text"] == text
        kept = get("/journal", branch=1)
        assert kept.content.startswith(b"openacr journal 1\n")
    futures.shutdown()


def test_lanes_of_lines_have_the_alias_else_the_name_of_the_machine(quiet_panel: Served) -> None:
    def change(station: Station) -> int:
        history = station.times.history
        store = station.installation.store
        store.write_text(OFFSETS.output_name[36], "COOLANT")
        store.write_text(OFFSETS.input_name[257], "DOOR")
        history.card.send("SYS\rDIM DEF(10)\r#DEFINE lamp BIT37\r#DEFINE valve BIT 290\rPROG0\r")
        for flag in (36, 37, 257, 258, 290):
            history.card.bit[flag] = True
        history.advance(10)
        return history.lived_tk

    tick = quiet_panel.call(change)
    futures = ThreadPoolExecutor(1)
    url = f"{quiet_panel.url}/api/timeline/lanes"
    query = {"branch": 0, "first": 0, "last": tick}
    asked = futures.submit(httpx.get, url, params=query, timeout=LIMIT_S)
    while not wait((asked,), 0.005).done:
        quiet_panel.step(0.002)
    drawn = {each["flag"]: each for each in asked.result().json()["lanes"]}
    found = {flag: (drawn[flag]["name"], drawn[flag]["card"]) for flag in (36, 37, 257, 258, 290)}
    assert found == {
        36: ("COOLANT", "OUT 36"),
        37: ("lamp", "OUT 37"),
        257: ("DOOR", "XIO 0 INP 01"),
        258: ("XIO 0 INP 02", ""),
        290: ("valve", "XIO 0 OUT 34"),
    }
    futures.shutdown()


def test_a_server_that_ends_in_a_pause_brings_its_machine_to_rest(tmp_path: Path) -> None:
    served = Served(tmp_path, by_hand=True)
    served.step(0.1)

    def pause_in_motion(station: Station) -> None:
        axis = station.link.machine.runner.settings.named("X").index
        station.hand_motion.increment(
            axis, 1, preset=0, distance_u=50.0, speed_ups=None, fast=False
        )
        station.times.history.advance(400)
        station.times.pause()

    served.call(pause_in_motion)
    card = served.station.times.history.card
    served.close()
    assert not any(int(card.p[af1.word[axis]]) & af1.JOG_ACTIVE for axis in range(3))
    assert card.axis(0).commanded_u < 50.0


def test_steps_that_fail_in_a_pause_end_what_moves(
    hand: HandStation,
) -> None:
    hand.do("jog.increment", axis="X", direction=1, distance=50.0, tick=hand.tick)
    hand.run(0.3)
    hand.do("timeline.pause")
    for _ in range(6):
        hand.station.fail("a defect", is_new=True)
    assert not hand.station.link.is_still
    hand.until(lambda: not hand.is_busy)
    assert hand.places()[0] < 50.0


def test_a_stream_that_the_panel_has_opened_is_its_own_and_that_of_another_host_is_not(
    hand: HandStation,
) -> None:
    history = hand.station.times.history
    own, other = (
        history.open_stream(StreamKind.TERMINAL),
        history.card.open_stream(StreamKind.TERMINAL),
    )
    assert own in history.own_streams
    assert other not in history.own_streams
