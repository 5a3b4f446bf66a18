"""A debugged part program: where it stops, forwards and backwards, and what is seen there."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.debugger.client import Client
from tests.debugger.part_programs import COUNTING, CUTTING, SPINDLE, target_of

from openacr.cnc.loading.load import load
from openacr.cnc.state.cells import LOCAL
from openacr.debugger.breakpoints import Fault, LineBreakpoint
from openacr.debugger.part_programs.target import PartTarget
from openacr.debugger.stops import Reason, Stop
from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.map.words import mf1
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.timeline import Moment

LONG_TK = 10**6
PULSES = 10_000.0
CYCLES = """\
F600 S100 M3
P200=1
G41 D1 G1 X1
Y1
X0
G40 X0 Y0
G81 X0.5 Y0.5 Z-0.1 R0.1
X0.75
G80
G2 X1 I0.875 J0.5
M2
$I CYCLES.TXT
"""


def line(target: PartTarget) -> int:
    return target.frames(0)[0].line


def place(target: PartTarget) -> tuple[int, int, str, float]:
    """Line, tick, P200 and the commanded position of X."""
    now = target.course.timeline.now
    return line(target), now.tick, target.answer(0, "P200"), target.card.axis(0).commanded_u


def steps(target: PartTarget, *, into: bool = False) -> Iterator[Stop]:
    """Steps until the end."""
    stop = None
    while stop is None or stop.reason is not Reason.END:
        target.course.begin_step(0, into=into)
        stop = target.course.run(LONG_TK)
        assert stop is not None
        yield stop


@pytest.fixture
def target(tmp_path: Path) -> PartTarget:
    target = target_of(tmp_path)
    assert target.course.entry() == Stop(Reason.ENTRY)
    return target


def breaks(target: PartTarget, *wanted: int, **options: str) -> None:
    found = target.places_of(str(target.shop.program and target._file), 0, frozenset(wanted))
    target.course.set_lines([LineBreakpoint(*found[each], **options) for each in wanted])  # type: ignore[arg-type]


def test_it_begins_at_its_first_block(target: PartTarget) -> None:
    assert (line(target), target.owners()) == (1, [(0, "part.nc")])
    assert target.card.axis(0).commanded_u == 0.0


def test_every_block_is_stepped_in_the_order_of_execution(target: PartTarget) -> None:
    lines = [line(target)]
    for stop in steps(target, into=True):
        assert stop.reason in (Reason.STEP, Reason.END)
        lines.append(line(target))
    assert lines == [1, 2, 3, 4, 5, 3, 4, 5, 8, 12, 13, 14, 9, 10, 11, 11]
    assert stop == Stop(Reason.END, 0, "the part program has ended")


def test_steps_pass_over_routines_or_go_into_them_or_out(target: PartTarget) -> None:
    breaks(target, 8)
    assert target.course.run(LONG_TK) == Stop(Reason.BREAKPOINT, 0)
    target.course.begin_step(0)
    target.course.run(LONG_TK)
    assert line(target) == 9
    target.course.step_back(0)
    assert line(target) == 14
    target.course.step_back(0)
    assert [frame.line for frame in target.frames(0)] == [13, 8]
    target.course.begin_step(0)
    target.course.run(LONG_TK)
    assert line(target) == 14
    target.course.step_back(0)
    target.course.begin_step(0, out=True)
    target.course.run(LONG_TK)
    assert line(target) == 9


def test_a_motion_stops_where_it_begins_to_the_tick(target: PartTarget) -> None:
    breaks(target, 4)
    assert target.course.run(LONG_TK) == Stop(Reason.BREAKPOINT, 0)
    counter = target.shop.machine.counter
    assert (target.card.memory.I[counter], target.answer(0, "P200")) == (1, "1")
    target.course.tick_back()
    assert target.card.memory.I[counter] == 0
    target.course.tick()
    assert target.course.run(LONG_TK) == Stop(Reason.BREAKPOINT, 0)
    assert (target.card.memory.I[counter], target.answer(0, "P200")) == (2, "0")
    assert target.card.axis(0).commanded_u == pytest.approx(1.0, abs=2 / PULSES)


def test_a_wait_is_come_to_at_rest(target: PartTarget) -> None:
    breaks(target, 9)
    target.course.run(LONG_TK)
    assert line(target) == 9
    assert target.card.axis(2).commanded_u == 0.1
    begin = target.course.timeline.now.tick
    target.course.begin_step(0)
    target.course.run(LONG_TK)
    assert line(target) == 10
    assert 0.2 <= (target.course.timeline.now.tick - begin) * target.course.period_s < 0.3


def test_debugging_changes_nothing_of_the_run(tmp_path: Path) -> None:
    store = Store()
    shop = MillSession.virtual(store, lambda text: None)
    shop.start(load(CYCLES, shop.cells, name="part.nc"), Start(is_repeated=False))
    while shop.runner.is_busy:
        shop.step()
        shop.carry_on()
    target = target_of(tmp_path, CYCLES)
    target.course.entry()
    for _ in steps(target, into=True):
        target.course.tick_back()
        target.course.tick()  # over the latest moment again
    assert shop.virtual_card is not None
    assert target.card.lived_tk == shop.virtual_card.lived_tk
    assert target.card.digest() == shop.virtual_card.digest()


def test_compensated_blocks_and_cycles_are_stepped_one_by_one(tmp_path: Path) -> None:
    target = target_of(tmp_path, CYCLES)
    target.course.entry()
    lines = [line(target)]
    for _ in steps(target, into=True):
        lines.append(line(target))
    assert lines == [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 11]


def test_steps_back_are_the_steps_forward_in_reverse(target: PartTarget) -> None:
    places = [place(target)]
    for _ in steps(target, into=True):
        places.append(place(target))
    back = [places[-1]]
    while target.course.step_back(0).reason is Reason.STEP:
        back.append(place(target))
    assert [each[:3] for each in back] == [each[:3] for each in reversed(places[:-1])]
    assert [each[3] for each in back] == [each[3] for each in reversed(places[:-1])]
    forward = [place(target)]
    for _ in steps(target, into=True):
        forward.append(place(target))
    assert forward == places


def test_within_a_motion_a_step_back_goes_to_its_beginning(target: PartTarget) -> None:
    breaks(target, 4)
    target.course.run(LONG_TK)
    begin = target.course.timeline.now.tick
    target.course.set_lines([])
    assert target.course.run(500) is None
    assert target.course.paused(0) == Stop(Reason.PAUSE, 0)
    assert (line(target), target.course.timeline.now.tick) == (4, begin + 500)
    target.course.step_back(0)
    assert (line(target), target.course.timeline.now.tick) == (4, begin)


def test_running_on_from_the_past_passes_the_latest_moment(target: PartTarget) -> None:
    breaks(target, 10)
    target.course.run(3000)
    latest = target.course.timeline.now
    target.course.seek(Moment(latest.tick - 2500))
    assert target.course.run(1000) is None
    assert target.course.timeline.is_past
    assert target.course.run(LONG_TK) == Stop(Reason.BREAKPOINT, 0)
    assert (line(target), target.card.axis(2).commanded_u) == (10, 0.1)
    assert target.course.live.alarms == 0


def test_running_back_within_a_block_finds_its_beginning(target: PartTarget) -> None:
    breaks(target, 4)
    target.course.run(LONG_TK)
    begin = target.course.timeline.now
    assert target.course.run(100) is None
    assert target.course.run_back() == Stop(Reason.BREAKPOINT, 0)
    assert target.course.timeline.now == begin


def test_ticks_go_back_to_the_first_block_and_no_further(target: PartTarget) -> None:
    begin = target.course.timeline.now
    target.course.tick()
    while target.course.timeline.now.tick > begin.tick + 1:
        target.course.tick_back()
    assert target.course.tick_back() == Stop(Reason.STEP, 0, "one servo interrupt back")
    assert target.course.timeline.now == begin
    assert target.course.tick_back().reason is Reason.ENTRY


def test_stops_of_the_program_are_continued(tmp_path: Path) -> None:
    target = target_of(tmp_path, "F600 G1 X0.1\nM0\nX0.2\nM2\n")
    target.course.entry()
    assert target.course.run(LONG_TK) == Stop(Reason.END, 0, "the part program has ended")
    assert target.card.axis(0).commanded_u == 0.2


def test_running_back_finds_the_stops_in_reverse(target: PartTarget) -> None:
    breaks(target, 4, 9)
    found = []
    while target.course.run(LONG_TK) == Stop(Reason.BREAKPOINT, 0):
        found.append(place(target))
    assert [each[0] for each in found] == [4, 4, 9]
    back = []
    while target.course.run_back() == Stop(Reason.BREAKPOINT, 0):
        back.append(place(target))
    assert back == found[::-1]
    assert line(target) == 1
    assert target.course.run_back() == Stop(Reason.ENTRY, 0, "the beginning of what is known")


def test_a_condition_is_of_the_moment_of_its_block(target: PartTarget) -> None:
    breaks(target, 4, condition="P200 = 0")
    assert target.course.run(LONG_TK) == Stop(Reason.BREAKPOINT, 0)
    assert place(target)[2] == "0"
    assert target.course.run(LONG_TK) is not None
    breaks(target, 3, condition="P200 = 2")
    assert target.course.run_back() == Stop(Reason.BREAKPOINT, 0)
    assert place(target)[2] == "2"


def test_conditions_and_watches_read_the_card_where_it_is(target: PartTarget) -> None:
    position = f"P{axes.current_position[0]}"
    breaks(target, 4, condition="P200 = 0")
    target.course.run(LONG_TK)
    assert target.answer(0, position) == "10000"
    target.course.seek(Moment(target.course.live.reached_tk(0)))
    assert target.answer(0, position) == "0"


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("P200 +", r"P200 \+: E\d+ "),
        ("1/0", "1/0: "),
        ("P200 7", "P200 7: E108"),
        ("", ": E"),
    ],
)
def test_an_expression_that_has_no_value_is_refused(
    target: PartTarget, expression: str, message: str
) -> None:
    with pytest.raises(UserError, match=message):
        target.answer(0, expression)


def test_values_are_those_before_the_block(target: PartTarget) -> None:
    breaks(target, 13)
    target.course.run(LONG_TK)
    scopes = {
        name: {value.name: value.text for value in values} for name, values in target.scopes(0, 0)
    }
    assert scopes["Block"]["block"] == "G0 Z0.1"
    assert scopes["Block"]["codes"] == "G1 G17 G20 G90 G94 G40 G49 G54 G64 G98"
    assert scopes["Block"]["plane"] == "G17 XY"
    assert (scopes["Block"]["F"], scopes["Block"]["coolant"]) == ("60", "off")
    assert list(scopes["Parameters"]) == ["P200", *(f"P{LOCAL + axis}" for axis in range(8))]
    assert (scopes["Parameters"]["P200"], scopes["Parameters"][f"P{LOCAL}"]) == ("0", "0.25")
    assert scopes["Offsets"]["all together"] == "X0.25 Y0 Z0"
    assert scopes["Offsets"]["local (G52)"] == "X0.25 Y0 Z0"
    assert scopes["Offsets"]["G54"] == "X0 Y0 Z0"
    assert list(scopes["Axes"])[:2] == ["program position", "X (AXIS0)"]
    target.course.step_back(0)
    offsets = {value.name: value.text for value in dict(target.scopes(0, 0))["Offsets"]}
    assert offsets["all together"] == "X0 Y0 Z0"
    assert target.frames(1) == []
    with pytest.raises(UserError, match="has not come to a block"):
        list(target.scopes(1, 0))  # the part program is the only owner


def test_a_parameter_is_changed_for_what_is_not_read_yet(tmp_path: Path) -> None:
    text = "P200=1\nF600 G1 X0.5\nP201=P0\nG1 Y(P200)\nM2\n"  # reading P0 waits for rest
    target = target_of(tmp_path, text)
    target.course.entry()
    breaks(target, 2)
    target.course.run(LONG_TK)
    target.assign(0, "P200", "P200/4")
    assert target.answer(0, "P200") == "1"
    list(steps(target))
    assert target.card.axis(1).commanded_u == 0.25
    target.course.step_back(0)
    with pytest.raises(UserError, match="only the latest moment changes"):
        target.assign(0, "P200", "1")
    with pytest.raises(UserError, match="only the latest moment changes"):
        target.typed(0, "P1=2")


@pytest.mark.parametrize("name", ["P12288", "X", "P650000", "LV0"])
def test_other_values_are_not_changed(target: PartTarget, name: str) -> None:
    with pytest.raises(UserError, match=r"can be changed|is not a parameter that programs write"):
        target.assign(0, name, "1")


def test_lines_of_other_files_and_empty_lines_are_no_places(
    target: PartTarget, tmp_path: Path
) -> None:
    file, every = str(tmp_path / "part.nc"), range(0, 99)
    assert sorted(target.places_of(file, 0, every)) == [1, 2, 3, 4, 5, 8, 9, 10, 11, 12, 13, 14]
    assert sorted(target.places_of(file, 0, frozenset([3, 7]))) == [3]
    assert target.places_of(str(tmp_path / "other.nc"), 0, every) == {}


def test_an_alarm_stops_if_it_is_wanted_and_ends_the_program(tmp_path: Path) -> None:
    text = "F600 G1 X0.1\nP200=1/P201\nM2\n"
    target = target_of(tmp_path, text)
    target.course.entry()
    target.course.set_faults(frozenset([Fault.PROGRAM]))
    stop = target.course.run(LONG_TK)
    assert stop is not None
    assert (stop.reason, line(target)) == (Reason.EXCEPTION, 2)
    assert stop.text.startswith("alarm 60: ")
    assert "division by zero" in stop.text
    assert target.course.run(LONG_TK) == Stop(Reason.END, 0, "the part program has ended")
    target.course.step_back(0)
    assert line(target) == 2
    target.course.step_back(0)
    assert line(target) == 1


@pytest.mark.parametrize("is_past", [False, True])
def test_what_is_closed_is_at_rest_with_its_outputs_off(tmp_path: Path, is_past: bool) -> None:
    target = target_of(tmp_path, CUTTING, SPINDLE)
    target.course.entry()
    assert target.course.run(2000) is None
    word = mf1.word[target.shop.machine.master]
    assert target.card.memory.I[word] & mf1.IN_MOTION
    assert [target.card.bit[each] for each in (40, 41)] == [True, True]
    if is_past:
        target.course.seek(Moment(target.card.lived_tk - 1500))
    target.close()
    assert not target.card.memory.I[word] & mf1.IN_MOTION
    assert [target.card.bit[each] for each in (40, 41)] == [False, False]
    assert target.card.axis(0).commanded_u < 20.0


def test_the_earliest_blocks_are_forgotten(tmp_path: Path) -> None:
    target = target_of(tmp_path, "F600\n" + "G1 X1\nX0\n" * 8 + "M2\n")
    target.course.most_blocks = 3
    target.course.entry()
    lines = [line(target) for _ in steps(target)]
    assert lines == [*range(2, 19), 18]
    back = []
    while target.course.step_back(0).reason is Reason.STEP:
        back.append(line(target))
    assert back[:4] == [17, 16, 15, 14]
    assert len(back) < 8
    with pytest.raises(UserError, match="is before the first block that is known"):
        target.course.seek(Moment(1))


def test_a_program_with_errors_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"part.nc:1:.*\(and 1 more: `openacr mill check`\)"):
        target_of(tmp_path, "G1 XX\nG1 YY\nM2\n")


def test_an_editor_debugs_a_part_program(client: Client, tmp_path: Path) -> None:
    file = tmp_path / "part.nc"
    file.write_text(COUNTING)
    client.launch(tmp_path, program="", partProgram=str(file), dialect="acromill")
    assert client.event("capabilities")["capabilities"]["supportsDataBreakpoints"] is False
    found = client.ask(
        "setBreakpoints", source={"path": str(file)}, breakpoints=[{"line": 4}, {"line": 6}]
    )
    assert [each["verified"] for each in found["breakpoints"]] == [True, False]
    client.ask("setExceptionBreakpoints", filters=["program-error"])
    client.ask("configurationDone")
    assert client.stop() == ("entry", 1)
    assert client.ask("threads") == {"threads": [{"id": 1, "name": "part.nc"}]}
    client.ask("continue", threadId=1)
    assert client.stop() == ("breakpoint", 1)
    assert (client.place(1), client.value("P200")) == (("part.nc", 4), "1")
    names = [each["name"] for each in client.ask("scopes", frameId=100)["scopes"]]
    assert names == ["Block", "Parameters", "Offsets", "Axes", "Time"]
    client.ask("stepBack", threadId=1)
    client.stop()
    assert client.place(1) == ("part.nc", 3)
    (data,) = client.ask("setDataBreakpoints", breakpoints=[{"dataId": "P12288"}])["breakpoints"]
    assert not data["verified"]
    assert "no value is watched" in data["message"]
    assert client.ask("openacrTimeline")["branch"] == 0
    client.ask("setBreakpoints", source={"path": str(file)}, breakpoints=[])
    client.ask("continue", threadId=1)
    assert client.stop() == ("end", 1)
    assert client.end() == 0
