"""M codes, reference points, probing and parameters of the card on the virtual machine."""

from pathlib import Path

import pytest
from tests.mill.shop import PULSES, Shop

from openacr.map import numbers as n
from openacr.mill.run.lifecycle import State
from openacr.sysvar import Store
from openacr.sysvar.tabs import TOOL
from openacr.sysvar.values import SettingError

DAC_VALUE = 6400 + 16 * 3
CW, CCW, OFF, MIST, FLOOD, NONE_FLOWS = 40, 41, 45, 42, 43, 44
SPINDLE = {
    "P800_001": 0.00333, "P800_002": 3.0, "P800_005": CW, "P800_006": CCW, "P800_007": OFF,
    "P800_009": MIST, "P800_010": FLOOD, "P800_011": NONE_FLOWS,
}  # fmt: skip
PROBE_INPUTS = (24, 25, 26)  # what hardware capture of axes 0 to 2 sees


def alarms(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def at_m0(shop: Shop, *, go_on: bool = True) -> None:
    """Wait for the M0 that comes next, look at the outputs, then START."""
    shop.until(State.HOLD)
    shop.pass_time(0.05)
    if go_on:
        shop.runner.start()


# --- spindle, coolant, outputs ------------------------------------------------------------


@pytest.mark.req("MILL-M3", "MILL-M4", "MILL-M5")
def test_the_spindle_turns_both_ways_and_stops() -> None:
    shop = Shop(**SPINDLE)
    shop.load("S1000\nM3\nM0\nM4\nM0\nM5\nM0\nM3\nM0\nM5\nM0\nM2\n")
    seen = []
    for _ in range(5):
        at_m0(shop, go_on=False)
        volts = float(shop.controller.p[DAC_VALUE])
        seen.append((*shop.outputs((CW, CCW, OFF)), round(volts, 6)))
        shop.runner.start()
    assert seen == [
        (True, False, False, 3.33),
        (False, True, False, 3.33),
        (False, False, True, 0.0),
        (True, False, False, 3.33),
        (False, False, True, 0.0),
    ]


@pytest.mark.req("MILL-VAR-CUSTOM")
@pytest.mark.parametrize(
    ("line", "detail"),
    [("P200=1/P201", "M300.TXT:2:1: E210"), ("GOTO (P201+77)", "M300.TXT:2:1: E220")],
)
def test_a_code_of_the_user_that_fails_stops_the_machine_with_an_alarm(
    line: str, detail: str, tmp_path: Path
) -> None:
    (tmp_path / "M300.TXT").write_text(f"P201=0\n{line}\nRET\n")
    shop = Shop()
    shop.store.write_text(TOOL.custom_m_folder, str(tmp_path))
    shop.load("F600 G1 X1\nM300\nX2\nM2\n")
    shop.until(State.ALARM)
    assert alarms(shop) == [60]
    assert detail in shop.runner.alarms.active[0].text
    assert shop.pulses() == (10_000, 0, 0)


@pytest.mark.req("MILL-M7", "MILL-M8", "MILL-M9")
def test_coolants_are_outputs() -> None:
    shop = Shop(**SPINDLE)
    shop.load("M7\nM0\nM9\nM0\nM8\nM0\nM7\nM0\nM9\nM0\nM2\n")
    seen = []
    for _ in range(5):
        at_m0(shop, go_on=False)
        seen.append("".join(str(int(on)) for on in shop.outputs((MIST, FLOOD, NONE_FLOWS))))
        shop.runner.start()
    assert seen == ["100", "001", "010", "110", "001"]


def test_thirteen_outputs_go_on_and_off_on_the_card() -> None:
    cells = {f"P{400_100 + k}": 40.0 + k for k in range(1, 14)}
    numbers = range(41, 54)
    shop = Shop(**cells)
    every = "".join(f"M{code}\n" for code in range(12, 25))
    shop.load(f"{every}M0\n{''.join(f'M{code} M0{chr(10)}' for code in range(25, 38))}M2\n")
    at_m0(shop)
    assert shop.outputs(numbers) == [True] * 13
    for off in range(1, 14):
        at_m0(shop)
        assert shop.outputs(numbers) == [k > off for k in range(1, 14)]


# --- stops and waits ----------------------------------------------------------------------


@pytest.mark.req("MILL-M0")
@pytest.mark.parametrize("go_on", ["START", "RESUME", "Cycle Start"])
def test_m0_holds_with_everything_as_it_is_until_start_or_resume(go_on: str) -> None:
    shop = Shop(**SPINDLE, P400_003=9)
    shop.load("G91 F600 S500\nM3\nM8\nG1 X1\nM0\nX1\nM2\n")
    shop.until(State.HOLD)
    shop.pass_time(2.0)
    assert shop.runner.reason == "M0"
    assert shop.outputs((CW, FLOOD)) == [True, True]
    assert shop.pulses() == (10_000, 0, 0)
    if go_on == "START":
        shop.runner.start()
    elif go_on == "RESUME":
        shop.runner.resume()
    else:
        shop.controller.set_input(9, True)
        shop.pass_time(0.05)
    assert shop.runner.state is State.RUN
    shop.until(State.IDLE)
    assert shop.pulses() == (20_000, 0, 0)


@pytest.mark.req("MILL-M1")
@pytest.mark.parametrize("is_on", [True, False])
def test_m1_is_m0_with_the_optional_stop(is_on: bool) -> None:
    shop = Shop(P400_001=9)
    shop.controller.set_input(9, is_on)
    shop.load("F600\nG1 X1\nM1\nX2\nM2\n")
    assert shop.until(State.HOLD, State.IDLE) is (State.HOLD if is_on else State.IDLE)
    assert shop.pulses()[0] == (10_000 if is_on else 20_000)


@pytest.mark.req("MILL-M6")
@pytest.mark.parametrize("is_manual", [1, 0])
def test_m6_goes_on_when_the_change_is_acknowledged(is_manual: int) -> None:
    shop = Shop(P900_000=14, P900_001=46, P900_002=is_manual)
    shop.load("F600\nT7\nM6\nG1 X1\nM2\n")
    shop.pass_time(2.0)
    assert shop.outputs((46,)) == [True]
    assert shop.runner.state is State.WAIT
    assert shop.runner.reason == ("load tool 7" if is_manual else "tool 7 is changed")
    assert shop.pulses()[0] == 0
    shop.controller.set_input(14, True)
    shop.pass_time(0.1)
    shop.controller.set_input(14, False)
    shop.until(State.IDLE)
    assert shop.outputs((46,)) == [False]
    assert shop.store.read(235) == 7
    assert shop.pulses()[0] == 10_000


@pytest.mark.req("MILL-M1XX-ABORT")
@pytest.mark.parametrize("is_emergency", [False, True])
@pytest.mark.parametrize(
    ("code", "reason"), [("M105", "M105: relay 5 on"), ("M207", "M207: relay 7 off")]
)
def test_a_wait_for_a_relay_is_shown_and_can_be_ended(
    code: str, reason: str, is_emergency: bool
) -> None:
    shop = Shop(P400_004=12)
    shop.controller.bit[128 + 7] = True
    shop.load(f"F600\n{code}\nG1 X1\nM2\n")
    shop.pass_time(0.5)
    assert shop.runner.state is State.WAIT
    assert shop.runner.reason == reason
    if is_emergency:
        shop.controller.set_input(12, True)
    else:
        shop.runner.abort()
    assert shop.until(State.IDLE, State.ALARM, limit_s=0.2) is not State.WAIT
    shop.controller.bit[128 + 5] = True
    shop.pass_time(0.5)
    assert shop.pulses()[0] == 0


@pytest.mark.req("MILL-M1XX", "MILL-M2XX")
def test_relays_let_the_program_go_on() -> None:
    shop = Shop()
    shop.load("F600\nM105\nG1 X1\nM205\nX2\nM2\n")
    shop.pass_time(0.5)
    assert shop.pulses()[0] == 0
    shop.controller.bit[128 + 5] = True
    shop.pass_time(0.5)
    assert shop.pulses()[0] == 10_000
    shop.controller.bit[128 + 5] = False
    shop.until(State.IDLE)
    assert shop.pulses()[0] == 20_000


# --- reference points ---------------------------------------------------------------------

REFERENCE = {"P280": 1.0, "P281": 2.0, "P282": 0.5, "P400_010": 15.0, "P400_011": 46.0}


def referenced(text: str, *, answers: bool, **cells: float) -> tuple[Shop, list[bool]]:
    """Run it with the G27 switch following its output; what the output did."""
    shop = Shop(**REFERENCE, **cells)
    shop.load(text)
    seen: list[bool] = []
    while shop.runner.is_busy:
        shop.pass_time(0.005)
        is_on = shop.outputs((46,))[0]
        if not seen or seen[-1] != is_on:
            seen.append(is_on)
        if answers:
            at_point = shop.place() == pytest.approx((1.0, 2.0, 0.5), abs=2e-4)
            shop.controller.set_input(15, is_on and at_point)
    return shop, seen


@pytest.mark.req("MILL-G27")
def test_g27_checks_the_reference_point_and_goes_on_to_its_words() -> None:
    shop, seen = referenced("G27 X3 Y3 Z1\nM2\n", answers=True)
    assert seen == [False, True, False]
    assert alarms(shop) == []
    assert shop.pulses() == (30_000, 30_000, 10_000)


@pytest.mark.req("MILL-G27-FAIL")
def test_g27_without_an_answer_stops_the_program() -> None:
    shop, seen = referenced("G27 X3 Y3 Z1\nG0 X9\nM2\n", answers=False)
    assert alarms(shop) == [31]
    assert shop.runner.state is State.ALARM
    assert seen == [False, True]  # the output stays on
    assert shop.pulses() == (10_000, 20_000, 5_000)


@pytest.mark.req("MILL-G27-OFFSET")
def test_g27_with_an_offset_misses_the_point() -> None:
    length = {"P2001": 0.25}
    shop, _ = referenced("G43 H1\nG27 X3 Y3 Z1\nM2\n", answers=True, **length)
    assert alarms(shop) == [31]
    shop, _ = referenced("G43 H1\nG49\nG27 X3 Y3 Z1\nM2\n", answers=True, **length)
    assert alarms(shop) == []


@pytest.mark.req("MILL-G28-OFFSET", "MILL-G28-MISS")
@pytest.mark.parametrize(("before", "is_missed"), [("", False), ("G43 H1\n", True)])
def test_g28_checks_where_the_axes_stand(before: str, is_missed: bool) -> None:
    shop = Shop(P400_019=47, P2001=0.25, P280=1.0, P282=0.5)
    shop.load(f"{before}G28 X2 Z1\nG1 F600 Y1\nM2\n")
    state = shop.until(State.IDLE, State.ALARM)
    assert (state is State.ALARM) == is_missed
    assert alarms(shop) == ([32] if is_missed else [])
    assert shop.outputs((47,)) == [is_missed]
    assert shop.pulses() == (10_000, 0 if is_missed else 10_000, 7_500 if is_missed else 5_000)


# --- probing ------------------------------------------------------------------------------


def touched(
    text: str, wall: float, *, feed: int = 100, trailing: bool = False, **cells: float
) -> Shop:
    """Run a program with a probe whose input changes where X passes `wall`, tick by tick."""
    shop = Shop(P600_000=float(PROBE_INPUTS[0]), P600_001=float(trailing), **cells)
    for number in PROBE_INPUTS:
        shop.controller.set_input(number, trailing)
    shop.load(text.replace("F?", f"F{feed}"))
    while shop.runner.is_busy:
        for number in PROBE_INPUTS:
            counts = shop.controller.p[n.AX_BASE + n.AX_ACTUAL_POSITION]
            shop.controller.set_input(number, (counts / PULSES > wall) != trailing)
        shop.controller.advance(seconds=shop.controller.period_s)
        if shop.controller.tick % 10 == 0:
            shop.runner.step()
            shop.path.append(shop.place())
    assert alarms(shop) == []
    return shop


@pytest.mark.req("MILL-G31", "MILL-G31-RECT")
def test_g31_stops_goes_back_to_the_trip_and_drops_the_rest() -> None:
    shop = touched("N100 F? G1 X0Y0\nN110 G31 X1\nN120 Y1\nN130 X0\nN140 Y0\nM2\n", 0.75)
    furthest = max(x for x, *_ in shop.path)
    assert 0.75 + 0.0139 < furthest < 0.9  # the ramp, and the time to see the trip
    at_top = [x for x, y, _ in shop.path if 0.01 < y < 0.99 and x > 0.1]
    assert at_top == pytest.approx([shop.store.read(101)] * len(at_top), abs=2e-4)
    assert shop.store.read(101) == pytest.approx(0.75, abs=2e-3)
    assert shop.pulses() == (0, 0, 0)


@pytest.mark.req("MILL-G31-STORE-DECEL")
def test_what_g31_stores_does_not_depend_on_the_feed() -> None:
    def found(feed: int) -> float:
        shop = touched("F?\nG31 X5\nM2\n", 2.0, feed=feed)
        assert max(x for x, *_ in shop.path) > 2.0 + (feed / 60) ** 2 / 2 / 100 * 0.9
        return shop.store.read(101)

    # the input is seen once in a tick: the point lies within one tick of the wall
    for feed in (100, 1000):
        assert 0.0 <= found(feed) - 2.0 <= feed / 60 * 0.0005 * 2 + 1e-4


@pytest.mark.req("MILL-G31-EDGE")
@pytest.mark.parametrize("trailing", [False, True])
def test_the_edge_of_the_probe_can_be_chosen(trailing: bool) -> None:
    shop = touched("F?\nG31 X5\nM2\n", 0.5, trailing=trailing)
    assert shop.store.read(101) == pytest.approx(0.5, abs=2e-3)
    assert shop.place()[0] == pytest.approx(shop.store.read(101), abs=2e-4)


# --- parameters of the card ---------------------------------------------------------------


@pytest.mark.req("MILL-P-0-33", "MILL-P-NONPERSIST")
def test_p0_to_p33_are_variables_of_the_card_and_go_with_its_power() -> None:
    shop = Shop()
    shop.run_text("P0=1.5\nP33=P0*2\nG1 F600 X(P33)\nM2\n")
    assert [shop.controller.p[k] for k in (0, 33)] == [1.5, 3.0]
    assert shop.pulses()[0] == 30_000
    shop.controller.send("SYS\rREBOOT\r")
    again = Shop.on(shop.controller, {})
    assert [again.controller.p[k] for k in (0, 33)] == [0.0, 0.0]


@pytest.mark.req("MILL-P-34-99", "MILL-P-NONPERSIST")
def test_p34_to_p89_go_with_the_power_of_the_card() -> None:
    shop = Shop()
    shop.run_text("P34=1.5\nP89=P34*2\nM2\n")
    assert [shop.controller.p[k] for k in (34, 89)] == [1.5, 3.0]
    shop.controller.send("SYS\rREBOOT\r")
    again = Shop.on(shop.controller, {})
    assert [again.controller.p[k] for k in (34, 89)] == [0.0, 0.0]


@pytest.mark.req("MILL-P-4096-20487")
def test_programs_read_and_write_parameters_of_the_card() -> None:
    shop = Shop()
    text = "F600\nG1 X1\nG4 F.5\nP200=P6144\nP201=P12288\nP12368=25\nP202=P12368*2\nM2\n"
    shop.run_text(text)
    assert shop.store.read(200) == pytest.approx(10_000, abs=2)  # encoder 0
    assert shop.store.read(201) == 10_000  # current position of axis 0
    assert shop.store.read(202) == 50.0
    assert shop.controller.p[12368] == 25.0  # MAXVEL of axis 0


def test_t_p_puts_a_parameter_on_the_card() -> None:
    shop = Shop()
    shop.run_text("P3=55555\nT P3\nM2\n")
    assert shop.controller.p[3] == 55555


@pytest.mark.req("MILL-WCS-TEACH")
def test_the_position_of_the_machine_becomes_the_zero_of_a_work_system() -> None:
    shop = Shop()
    shop.runner.jog(lambda jog: jog.move(0, 1.5, fast=True))
    shop.pass_time(2.0)
    taught = shop.place()[0]
    shop.run_text("G10 L20 P2 X0 Y0 Z0\nM2\n")
    assert shop.store.read(920) == pytest.approx(taught)
    shop.run_text("F600\nG55\nG1 X1\nX0\nM2\n")
    assert shop.place()[0] == pytest.approx(taught)


# --- numbers of outputs -------------------------------------------------------------------

OUTPUTS = (400_011, 400_013, 400_019, *range(400_101, 400_114), *range(800_005, 800_008),
           *range(800_009, 800_013), 900_001)  # fmt: skip


@pytest.mark.req("MILL-M-OUTPUTS")
@pytest.mark.parametrize("cell", OUTPUTS)
def test_outputs_are_32_to_63_or_none(cell: int) -> None:
    store = Store()
    for number in (31, 64, 1, 999):
        with pytest.raises(SettingError, match=r"32 to 63|-1 to 511"):
            store.write(cell, number)
    for number in (32, 63, -1):
        store.write(cell, number)
        assert store.read(cell) == number


@pytest.mark.req("MILL-M-ACR2000")
def test_the_acr2000_has_16_inputs_and_16_outputs() -> None:
    store = Store()
    store.write(400_101, 48)
    with pytest.raises(SettingError, match="P400101"):
        store.write_text(100_002, "ACR2000")
    store.write(400_101, 47)
    store.write_text(100_002, "ACR2000")
    for cell, good, bad in ((400_102, 46, 48), (800_005, 32, 63), (400_002, 15, 16)):
        with pytest.raises(SettingError, match="of the card are"):
            store.write(cell, bad)
        store.write(cell, good)
