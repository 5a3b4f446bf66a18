"""Diagnostics: memory of the card, index profiles, inputs and outputs, limits of gains."""

from itertools import pairwise
from statistics import median

import httpx
import pytest
from tests.panel.bench import HandStation, Served

from openacr.map.rows import axes
from openacr.mill.card.machine_io import line_numbers
from openacr.panel.control.engineer.scope import Samples
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role
from openacr.sysvar.tabs import CONTROL

PROFILE = "ACC 500\nDEC 500\nSTP 250\nJRK 0\nF600\nRES X\nX5"


# --- memory ---------------------------------------------------------------------------


def test_the_memory_of_the_card_is_shown_and_divided_anew(hand: HandStation) -> None:
    before = hand.do("memory.read")
    assert (before["sizes"]["PROG1"], before["sizes"]["PLC0"]) == (65536, 0)
    assert len(before["sizes"]) == 16 + 8
    card = hand.station.link.machine.card
    card.command("10 PRINT 1", program=1)
    hand.do("memory.set", sizes={"PROG1": 8192, "PLC0": 2000}, confirm=True)
    hand.run(0.5)
    after = hand.do("memory.read")
    assert (after["sizes"]["PROG1"], after["sizes"]["PLC0"]) == (8192, 2000)
    assert after["free"] == before["free"] + 65536 - 8192 - 2000
    card = hand.station.link.machine.card
    assert card.command("LIST", program=1) == []
    hand.do("mdi.execute", line="G21 G90 G0 X5")  # the machine is set up again
    hand.until(lambda: not hand.is_busy)
    assert hand.places()[0] == 205.0


def test_a_division_that_cannot_be_is_refused_before_anything_is_lost(hand: HandStation) -> None:
    card = hand.station.link.machine.card
    card.command("10 PRINT 1", program=1)
    free = hand.do("memory.read")["free"]
    most = free + 8 * 65536
    for sizes, text in (
        ({"PROG1": most - 7 * 65536 + 1}, f"{most + 1} bytes in all: the card has {most}"),
        ({"PROG16": 100}, "PROG16: the card has PROG0, PROG1"),
        ({"PROG7": 0}, "PROG7 cannot be without memory: 1 byte at least"),
    ):
        assert text in hand.refused("memory.set", sizes=sizes, confirm=True)["text"]
    error = hand.refused("memory.set", sizes={"PLC1": 100})
    assert error["text"] == "programs, PLC programs and variables on the card are lost: confirm it"
    assert card.command("LIST", program=1) == ["10 PRINT 1"]
    other = Person(2, Role.SETUP, "10.0.0.2")
    hand.station.join(other)
    assert hand.send("memory.set", who=other, sizes={})["error"]["needs"] == "service"


def test_the_memory_is_not_divided_while_programs_run(hand: HandStation) -> None:
    card = hand.station.link.machine.card
    for line in ("10 DWL 1", "20 GOTO 10"):
        card.command(line, program=3)
    hand.do("card.run", program=3)
    hand.run(0.1)
    error = hand.refused("memory.set", sizes={"PLC0": 100}, confirm=True)
    assert error["text"] == "PROG3 of the card: running; halt it first"
    hand.do("card.halt", program=3)
    hand.do("mdi.execute", line="G21 G91 G1 X5 F600")
    for command, args in (("memory.read", {}), ("memory.set", {"sizes": {}, "confirm": True})):
        assert hand.refused(command, **args)["text"] == (
            "the machine moves: the memory is shown and changed at rest only"
        )
    hand.until(lambda: not hand.is_busy)
    hand.do("memory.set", sizes={"PLC0": 100}, confirm=True)


# --- index ----------------------------------------------------------------------------


def test_an_index_profile_is_run_and_recorded_from_its_start(hand: HandStation) -> None:
    taken: list[Samples] = []
    hand.station.on_samples = lambda _to, each: taken.append(each)
    before = hand.places()
    result = hand.do("scope.index", profile=PROFILE, channels=[12290], period_ms=5.0, samples=400)
    assert result["time_s"] == pytest.approx(5 / 10 + 10 / 2 / 500 + 10 / 2 / 250)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert [b - a for a, b in zip(before, hand.places(), strict=True)] == [5.0, 0.0, 0.0]
    values = [float(value) for _first, block, _period in taken for value in block[0]]
    scale = hand.station.link.machine.runner.settings.named("X").pulses_per_unit
    assert taken[0][0] == 0
    assert abs(values[0] - values[1]) <= 1.0  # recorded before it moved
    moved = [k for k, value in enumerate(values) if abs(value - values[0]) > 0.01 * scale]
    assert 0.005 * moved[0] < 0.1
    speeds = [(b - a) / scale / 0.005 for a, b in pairwise(values)]
    assert median(v for v in speeds if v > 9.0) == pytest.approx(10.0, rel=0.02)  # F600
    assert values[-1] - values[0] == pytest.approx(5.0 * scale, abs=2.0)
    assert hand.station.captures.of(1).scope.capture is not None
    hand.do("jog.increment", axis="X", direction=1, distance=1.0, tick=hand.tick)  # its own ramps
    hand.until(lambda: not hand.is_busy)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("ACC 1\nSPEED 3\nX1", "line 2 of the profile: 'SPEED 3': ACC, DEC, STP, JRK, F, RES"),
        ("ACC 1\nSTP 1\nF1\nW5", "line 4 of the profile: axis W is not configured"),
        ("ACC 1\nSTP 1\nF1", "the profile moves no axis"),
        ("ACC 1\nSTP 1\nF1\nX0", "the profile moves no axis"),
        ("STP 1\nF1\nX5", "the profile needs ACC above 0"),
        ("ACC 1\nSTP 0\nF1\nX5", "the profile needs STP above 0"),
        ("ACC 1\nSTP 1\nX5", "the profile needs F above 0"),
        ("ACC 1\nSTP 1\nF1\nJRK -1\nX5", "DEC and JRK of the profile cannot be negative"),
        ("ACC 1\nSTP 1\nF1\nX5\nX-5", "line 5 of the profile: X-5: nothing follows the move"),
    ],
)
def test_a_profile_that_is_none_moves_nothing(hand: HandStation, text: str, why: str) -> None:
    before = hand.places()
    error = hand.refused("scope.index", profile=text, channels=[12290])
    assert why in error["text"]
    hand.run(0.3)
    assert hand.places() == before
    assert hand.station.captures.of(1).scope.capture is None


def test_an_index_profile_that_is_stopped_ends_and_leaves_no_jerk(hand: HandStation) -> None:
    slow = PROFILE.replace("F600", "F60").replace("JRK 0", "JRK 900")
    hand.do("scope.index", profile=slow, channels=[12290])
    hand.run(0.5)
    hand.do("stop.hold")
    hand.until(lambda: not hand.is_busy)
    assert 0.0 < hand.places()[0] < 5.0
    assert hand.station.link.machine.card.read(axes.jog_jerk_setting[0]) == 0


# --- inputs and outputs ---------------------------------------------------------------

MODULES = CONTROL.io_expansion_modules


def points(panel: Served) -> tuple[list[int], list[int], list[int]]:
    found = httpx.get(f"{panel.url}/api/io").json()
    inputs, outputs = ([each["number"] for each in found[k]] for k in ("inputs", "outputs"))
    return inputs, outputs, found["words"]


def test_inputs_and_outputs_follow_card_and_modules(quiet_panel: Served) -> None:
    store = quiet_panel.panel.installation.store
    own = [4096, 4097]
    assert points(quiet_panel) == ([*range(32)], [*range(32, 64)], own)
    store.write(MODULES, 2)
    inputs, outputs, words = points(quiet_panel)
    assert inputs == [*range(32), *range(256, 288), *range(320, 352)]
    assert outputs == [*range(32, 64), *range(288, 320), *range(352, 384)]
    assert words == [*own, 4104, 4105, 4106, 4107]
    assert line_numbers(16, 1) == (
        [*range(16), *range(256, 288)], [*range(32, 48), *range(288, 320)]
    )  # fmt: skip


# --- gains ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("gain", "cell", "most"),
    [
        ("P Gain", 150_000, 10.0), ("I Gain", 150_001, 1e5), ("I Delay", 150_002, 1000.0),
        ("D Gain", 150_004, 10.0), ("D Time", 150_005, 1.0), ("ACC FFwd", 150_006, 10.0),
        ("Vel FFwd", 150_007, 10.0), ("FBVEL", 150_009, 10.0),
    ],
)  # fmt: skip
@pytest.mark.parametrize("store", [True, False])
def test_a_gain_beyond_its_range_is_refused_with_it(
    hand: HandStation, gain: str, cell: int, most: float, store: bool
) -> None:
    card, kept = hand.station.link.machine.card, hand.installation.store.read(cell)
    before = card.read_many(range(12288 + 16, 12288 + 24))
    error = hand.refused("gain.set", axis="X", gain=gain, value=999999, store=store)
    assert f"{gain} (axis 0) cannot be 999999: a number from 0 to {most:.0f} [" in error["text"]
    assert card.read_many(range(12288 + 16, 12288 + 24)) == before
    assert hand.installation.store.read(cell) == kept


def test_a_gain_entered_while_a_program_runs_is_stored_at_its_end(hand: HandStation) -> None:
    card, store = hand.station.link.machine.card, hand.installation.store
    before = store.read(150_000)
    hand.do("mdi.execute", line="G21 G91 G1 X2 F600")
    hand.run(0.05)
    assert hand.do("gain.set", axis="X", gain="P Gain", value=0.003) == {
        "value": 0.003, "is_stored": False
    }  # fmt: skip
    assert float(card.read(12288 + 16)) == pytest.approx(0.003)
    assert (hand.is_busy, store.read(150_000)) == (True, before)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.5)
    assert store.read(150_000) == 0.003


# --- watched values -------------------------------------------------------------------


def test_a_variable_that_the_card_does_not_have_is_left_out(hand: HandStation) -> None:
    seen: list[list[tuple[int, float]]] = []
    hand.station.watches.report = lambda _wish, _parameters, changed: seen.append(changed)
    hand.station.link.machine.card.write(3, 7.5)
    hand.do("watch.begin", topic="watch", parameters=[3, 4000, 12288], hz=20.0)
    hand.run(0.3)
    assert seen[0] == [(0, 7.5), (2, float(hand.station.link.machine.card.read(12288)))]
    assert "failed" not in " ".join(hand.said)
    hand.station.link.machine.card.write(3, 8.5)
    hand.run(0.2)
    assert seen[1] == [(0, 8.5)]
