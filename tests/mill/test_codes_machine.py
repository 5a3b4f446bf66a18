"""M codes, reference points, probing and parameters of the card on the virtual machine."""

from pathlib import Path

import pytest
from tests.mill.shop import Shop

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


def alarms(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def at_m0(shop: Shop, *, go_on: bool = True) -> None:
    """Wait for the M0 that comes next, look at the outputs, then START."""
    shop.until(State.HOLD)
    shop.pass_time(0.05)
    if go_on:
        shop.runner.start()


# --- spindle, coolant, outputs ------------------------------------------------------------


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


# --- reference points ---------------------------------------------------------------------


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
