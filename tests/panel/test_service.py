"""Terminal, scope, gains, buttons, library parts, drip feed: on a station driven by hand."""

import os
import tty

import pytest
from tests.panel.bench import HandStation

from openacr.panel.control.engineer.scope import Samples
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role


def typed(hand: HandStation) -> str:
    return "".join(event["text"] for event in hand.events("term"))


def test_the_terminal_types_lines_and_shows_what_the_card_prints(hand: HandStation) -> None:
    hand.do("term.open")
    hand.do("term.line", text="PRINT 6*7")
    hand.run(0.2)
    assert "PRINT 6*7" in typed(hand)
    assert "\r\n42\r\n" in typed(hand)
    hand.do("term.close")
    assert "not open" in hand.refused("term.line", text="X")["text"]


def test_each_terminal_is_a_stream_of_its_own(hand: HandStation) -> None:
    for terminal, line in ((0, "?P12288"), (3, "PROG3")):
        hand.do("term.open", terminal=terminal)
        hand.do("term.line", terminal=terminal, text=line)
    hand.run(0.2)
    texts = {
        n: "".join(each["text"] for each in hand.events("term") if each["terminal"] == n)
        for n in range(4)
    }
    assert texts[0].endswith("?P12288\r\n0\r\nSYS>")
    assert texts[3].endswith("PROG3\r\nP03>")
    assert (texts[1], texts[2]) == ("", "")
    hand.do("term.close", terminal=3)
    assert "not open" in hand.refused("term.key", terminal=3, key="esc")["text"]
    hand.do("term.key", terminal=0, key="esc")
    assert "$.terminal" in hand.refused("term.open", terminal=4)["text"]
    hand.do("term.open", terminal=2)
    hand.station.leave(1)
    assert [hand.station.terminals[n].clients for n in range(4)] == [set()] * 4


def test_the_terminal_only_asks_while_the_machine_moves(hand: HandStation) -> None:
    hand.do("term.open")
    hand.do("mdi.execute", line="G21 G91 G1 X50 F600")
    hand.run(0.2)
    assert "only lines that begin with ?" in hand.refused("term.line", text="CLR 520")["text"]
    hand.do("term.line", text="?P12288")
    hand.do("stop.all")


def test_the_terminal_needs_the_role_service(hand: HandStation) -> None:
    other = Person(2, Role.SETUP, "10.0.0.2")
    hand.station.join(other)
    assert hand.send("term.open", who=other)["error"]["needs"] == "service"


def test_a_flag_of_the_card_is_set_and_cleared_by_the_service(hand: HandStation) -> None:
    card = hand.station.link.machine.card
    for on in (True, True, False):
        assert hand.do("card.flag", flag=1920, on=on) == {"on": on}
        assert card.read_bit(1920) is on
    assert hand.refused("card.flag", flag=99999, on=True)["text"]
    other = Person(2, Role.SETUP, "10.0.0.2")
    hand.station.join(other)
    assert hand.send("card.flag", who=other, flag=1920, on=True)["error"]["needs"] == "service"
    stale = hand.send("card.flag", old_s=0.6, flag=1920, on=True)
    assert stale["error"]["code"] == "stale"
    assert not card.read_bit(1920)


def test_a_client_watches_256_parameters_at_most(hand: HandStation) -> None:
    hand.do("watch.begin", topic="watch", parameters=list(range(256)))
    text = hand.refused("watch.begin", topic="watch", parameters=list(range(257)))["text"]
    assert text == "257 parameters: 256 at most can be watched at once"


def test_queries_only_read(hand: HandStation) -> None:
    lines = hand.do("card.query", line="DIM")["lines"]
    assert any("PROG0" in line for line in lines)
    assert "only" in hand.refused("card.query", line="CLEAR")["text"]
    assert "only" in hand.refused("card.query", line="DIM P(5)")["text"]


def test_the_scope_samples_in_the_time_of_the_card(hand: HandStation) -> None:
    taken: list[Samples] = []
    hand.station.on_samples = lambda _to, each: taken.append(each)
    assert hand.installation.controller is not None
    begin_s = hand.installation.controller.time_s
    hand.do("scope.arm", channels=[12288, 12290], period_ms=1.0, samples=1000)
    hand.do("jog.increment", axis="X", direction=1, distance=1.0, tick=hand.tick)
    hand.run(0.5)
    hand.do("scope.stop")
    hand.run(0.1)
    count = sum(block.shape[1] for _first, block, _period in taken)
    passed_ms = 1000.0 * (hand.installation.controller.time_s - begin_s) - 100.0
    assert passed_ms - 2.0 <= count <= passed_ms + 1.0  # all of them are sent
    firsts = [first for first, _block, _period in taken]
    sizes = [block.shape[1] for _first, block, _period in taken]
    assert firsts == [sum(sizes[:k]) for k in range(len(sizes))]
    assert {(len(block), period) for _first, block, period in taken} == {(2, 0.001)}
    assert taken[0][1][0, 0] == 0.0
    assert not hand.events("scope")[-1]["running"]


def test_a_single_capture_ends_after_its_trigger(hand: HandStation) -> None:
    trigger = {"channel": 0, "level": 400.0, "slope": 1, "mode": "single", "before": 0.1}
    hand.do("scope.arm", channels=[12290], period_ms=1.0, samples=100, trigger=trigger)
    tick = hand.station.times.history.lived_tk + 1
    hand.run(0.3)
    assert hand.events("scope")[-1] == {
        "event": "scope", "running": True, "channels": ["P12290"], "period_s": 0.001,
        "first": 0, "samples": 100, "trigger": None, "swept": None, "tick": tick,
        "owner": "service 1", "number": 1, "to": 1,
    }  # fmt: skip
    hand.do("jog.increment", axis="X", direction=1, distance=1.0, tick=hand.tick)
    hand.run(1.0)
    last = hand.events("scope")[-1]
    assert last["running"] is False
    assert last["trigger"] > 300
    assert last["swept"] == last["trigger"]


def test_the_scope_has_eight_channels(hand: HandStation) -> None:
    nine = hand.refused("scope.arm", channels=[*range(9)])["text"]
    assert nine == "9 channels: the scope has 1 to 8"
    assert hand.refused("scope.arm", channels=[])["text"] == "0 channels: the scope has 1 to 8"
    error = hand.refused("scope.arm", channels=[12288, 1], trigger={"channel": 2})
    assert error["text"] == "trigger channel 2: there are 2"
    names = [5, "P12290", "BIT516", "axis0.actual position", "516", 1, 2, "bit0"]
    asked = hand.do("scope.arm", channels=names, period_ms=0)
    shown = ["P5", "P12290", "BIT516", "P12290", "P516", "P1", "P2", "BIT0"]
    assert (asked["channels"], asked["period_s"]) == (shown, 0.0005)  # of every servo period
    assert hand.do("scope.arm", channels=[1], period_ms=0.7)["period_s"] == 0.0005
    assert "P99999" in hand.refused("scope.arm", channels=["P99999"])["text"]
    long = hand.do("scope.arm", channels=[1], period_ms=0, sweep_ms=100)
    assert (long["samples"], long["trigger"]) == (200, None)
    for sweep_ms, samples in ((4.5, 9), (50000.5, 100001)):
        error = hand.refused("scope.arm", channels=[1], period_ms=0, sweep_ms=sweep_ms)
        assert f"has {samples} samples of 0.5 ms: 10 to 100000 are possible" in error["text"]
    hand.do("scope.stop")


def test_a_gain_acts_on_the_card_and_is_stored(hand: HandStation) -> None:
    hand.do("gain.set", axis="Y", gain="P Gain", value=0.003)
    card = hand.station.link.machine.card
    assert float(card.read(12288 + 256 + 16)) == pytest.approx(0.003)
    assert hand.installation.store.read(151_000) == 0.003
    hand.do("gain.set", axis="Y", gain="d gain", value=2e-5, store=False)
    assert hand.installation.store.read(151_004) == 1e-5
    assert "gains are" in hand.refused("gain.set", axis="Y", gain="X", value=1.0)["text"]
    assert "cannot be -1" in hand.refused("gain.set", axis="Y", gain="P Gain", value=-1.0)["text"]


def test_the_watchdog_of_this_machine_on_the_card_is_not_ended(hand: HandStation) -> None:
    assert "belongs to this machine" in hand.refused("card.halt", program=7)["text"]
    assert "name a program" in hand.refused("card.run")["text"]
    hand.do("card.halt", program=3)


def test_a_momentary_button_goes_off_with_its_browser(hand: HandStation) -> None:
    store = hand.installation.store
    store.write_text(980_000, "Door")
    store.write(980_001, 40)
    card = hand.station.link.machine.card
    hand.do("button", number=0, pressed=True)
    hand.run(0.05)
    assert card.read_bit(40)
    hand.station.leave(1)
    hand.run(0.05)
    assert not card.read_bit(40)


def test_a_toggle_button_changes_at_each_press(hand: HandStation) -> None:
    store, card = hand.installation.store, hand.station.link.machine.card
    store.write(980_021, 41)
    store.write(980_023, 1)
    for expected in (True, False):
        hand.do("button", number=1, pressed=True)
        hand.do("button", number=1, pressed=False)
        hand.run(0.05)
        assert card.read_bit(41) is expected
    assert "sets nothing" in hand.refused("button", number=2, pressed=True)["text"]


def test_a_tool_length_is_taught_from_the_position_of_z(hand: HandStation) -> None:
    hand.do("jog.increment", axis="Z", direction=-1, distance=12.5, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    assert hand.do("teach.length", h=3) == {"value": -12.5}
    assert hand.installation.store.read(2003) == -12.5


def test_a_library_part_is_made_and_loaded(hand: HandStation) -> None:
    from openacr.cnc.parts.library import names, part_named

    name = names()[0]
    result = hand.do("program.part", part=name)
    assert result["kind"] == "part"
    assert result["errors"] == 0
    size = part_named(name).sizes[0]
    error = hand.refused("program.part", part=name, values={f"P{size.cell}": size.high * 2 + 1})
    assert size.text in error["text"]


def test_a_program_runs_while_it_arrives_over_a_serial_line(hand: HandStation) -> None:
    master, slave = os.openpty()
    tty.setraw(slave)
    store = hand.installation.store
    store.write(250_116, 2)
    hand.station.settings.note_stored(frozenset({250_116}))
    hand.run(0.1)
    hand.do("program.drip", port=os.ttyname(slave))
    os.write(master, b"G21 G90\n" + b"".join(b"G0 X%d\n" % n for n in range(1, 11)))
    hand.until(lambda: hand.station.snapshot.work[0] >= 5.0)
    assert hand.is_busy
    os.write(master, b"G0 X20\nM2\n\x1a")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 20.0
    hand.do("program.drip", port=os.ttyname(slave))  # the port is free for another program
    os.write(master, b"G21 G90\nG0 X3\nM2\n\x1a")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 3.0
    os.close(master)
    os.close(slave)
