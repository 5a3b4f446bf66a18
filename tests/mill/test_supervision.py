"""What goes wrong in a run: alarms, what they do, and that the machine stops safely."""

import re
from pathlib import Path

import pytest
from tests.mill.shop import Shop, at, end, line, rapid, src

from openacr.client import Card
from openacr.cnc import canonical as c
from openacr.cnc.reading.findings import BlockError, Finding
from openacr.controller import Controller
from openacr.errors import StoreError
from openacr.mill.card import alarms
from openacr.mill.card.stopping import stop_all
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession
from openacr.sysvar import Store

ESTOP_CELL = 400_004


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def test_the_bulge_of_an_arc_counts_for_the_limits() -> None:
    shop = Shop(P200_000=2.0, P200_001=-2.0, P200_002=0, P271=1)
    bulge = c.Arc(src(2), at(1.5, 1), c.Plane.XY, (1.5, 0.0), 3.14159265, 1.0, 1.0, c.Pace(60.0))
    shop.start(line(1, at(1.5, -1)), bulge, end())
    shop.until(State.ALARM)
    assert "axis X would go to 2.5, 0.5 beyond its limit 2" in shop.runner.alarms.active[0].text


def test_a_program_error_stops_after_the_block_before() -> None:
    def entries(_host: object) -> object:
        yield line(1, at(1))
        raise BlockError(Finding("E210", "arithmetic error", "TEST.TXT", 2))

    shop = Shop()
    shop.runner.run(entries)  # type: ignore[arg-type]
    shop.until(State.ALARM)
    assert codes(shop) == [60]
    assert "E210" in shop.runner.alarms.active[0].text
    assert shop.pulses() == (10000, 0, 0)


@pytest.mark.parametrize(
    ("width", "state"), [(0.00001, State.ALARM), (0.05, State.IDLE), (0.0, State.IDLE)]
)
def test_exact_stops_wait_for_the_in_position_band(width: float, state: State) -> None:
    shop = Shop(P200_003=width, P150_000=0.0001 if state is State.ALARM else 0.00244)
    pace = c.Pace(600.0, c.PathMode.EXACT, is_confirmed=True)
    shop.start(c.Line(src(1), at(1), pace), rapid(2, at(0)), end())
    assert shop.until(state) is state
    assert codes(shop) == ([24] if state is State.ALARM else [])


CUTS = "G1 F60 X50\nM2\n"


@pytest.mark.req("MILL-ALM-SOURCES")
def test_a_hardware_limit_is_an_alarm() -> None:
    shop = Shop()
    shop.card.command("HLBIT X 8", program=0)
    shop.card.command("HLIM X 3", program=0)
    shop.load(CUTS)
    shop.pass_time(0.5)
    shop.controller.set_input(8, True)
    shop.until(State.ALARM)
    assert 13 in codes(shop)
    shop.pass_time(1.0)
    place = shop.place()
    shop.pass_time(0.5)
    assert shop.place() == place


def test_a_store_that_cannot_be_written_holds_until_it_can(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shop = Shop()
    shop.start(line(1, at(1)), c.SetCell(src(2), 500, 7.0), line(3, at(5)), end())
    real = shop.store.write

    def full(n: int, value: float) -> None:
        raise StoreError(f"P{n}: disk is full")

    monkeypatch.setattr(shop.store, "write", full)
    shop.pass_time(0.4)
    assert (shop.runner.state, codes(shop)) == (State.PAUSED, [63])
    assert "disk is full" in shop.runner.alarms.active[0].text
    monkeypatch.setattr(shop.store, "write", real)
    assert shop.runner.acknowledge() == []
    shop.runner.resume()
    shop.until(State.IDLE)
    assert (shop.pulses()[0], shop.store.read(500)) == (50000, 7.0)


@pytest.mark.req("MILL-ALM-LOG", "MILL-SYS-CTL-ERRFILE")
@pytest.mark.parametrize("is_off", [False, True])
def test_alarms_are_logged_with_their_time_unless_the_store_forbids_it(
    tmp_path: Path, is_off: bool
) -> None:
    store = Store(tmp_path / "sysvar.db")
    store.write(250_118, is_off)
    store.write(ESTOP_CELL, 5)
    controller = Controller()
    shop = MillSession.real(controller, store, say=print)
    controller.set_input(5, True)
    for _ in range(5):
        shop.step()
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [10]
    logs = [file.read_text() for file in tmp_path.glob("*.LOG")]
    if is_off:
        assert logs == []
    else:
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\S+  alarm 10  Emergency stop\n", logs[0])


def real(controller: Controller, said: list[str], store: Store) -> MillSession:
    store.write(ESTOP_CELL, 5)
    return MillSession.real(controller, store, said.append)


@pytest.mark.parametrize("is_released", [True, False])
def test_the_next_program_calls_an_emergency_stop_by_its_name(is_released: bool) -> None:
    """Also when the button was released meanwhile, and by another store; then it is forgotten."""
    controller = Controller()
    first = real(controller, [], Store())
    first.step()
    controller.set_input(5, True)
    first.step()
    first.step()
    first.close()
    assert controller.p[97] == 10
    controller.set_input(5, not is_released)
    second = real(controller, [], Store())
    second.step()
    assert [(alarm.kind.code, alarm.text) for alarm in second.runner.alarms.active] == [
        (10, "Emergency stop")
    ]
    assert bool(second.runner.acknowledge()) is not is_released
    controller.set_input(5, False)
    assert second.runner.acknowledge() == []
    assert controller.p[97] == 0
    second.step()
    second.card.kill_all()  # this one is another host's Ctrl-X
    controller.advance(seconds=3.0)
    second.step()
    second.step()
    assert 14 in [alarm.kind.code for alarm in second.runner.alarms.active]
    assert 10 not in [alarm.kind.code for alarm in second.runner.alarms.active]
    second.close()


def test_an_emergency_stop_that_was_cleared_elsewhere_names_no_later_kill() -> None:
    controller = Controller()
    real(controller, [], Store()).close()
    controller.p[97] = 10
    shop = real(controller, [], Store())
    shop.step()
    assert controller.p[97] == 0
    shop.card.kill_all()
    shop.step()
    shop.step()
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [6, 14]  # Ctrl-X halts
    shop.close()


def test_a_kill_without_a_known_cause_is_of_another_host() -> None:
    controller = Controller()
    shop = real(controller, [], Store())
    shop.card.kill_all()
    shop.step()
    shop.step()
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [6, 14]  # Ctrl-X halts
    assert controller.p[97] == 0  # only what this program kills is noted
    shop.close()


def test_a_machine_that_did_not_rest_is_known_to_the_next_program() -> None:
    controller = Controller()
    shop = real(controller, [], Store())
    shop.step()
    shop.runner.cut_power()
    shop.close()
    assert controller.p[97] == 15
    again = real(controller, [], Store())
    again.step()
    assert [alarm.kind.code for alarm in again.runner.alarms.active] == [15]
    assert again.runner.acknowledge() == []
    again.close()


@pytest.mark.parametrize("is_released", [True, False])
def test_a_stop_from_another_terminal_calls_an_emergency_stop_by_its_name(
    is_released: bool,
) -> None:
    controller, store = Controller(), Store()
    shop = real(controller, [], store)
    shop.step()
    with Card.open(controller) as other:
        assert stop_all(other, shop.runner.settings).cause is None
        shop.step()
        shop.runner.acknowledge()
        controller.set_input(5, True)
        shop.step()
        controller.set_input(5, not is_released)
        cause = stop_all(other, shop.runner.settings).cause
        assert cause is alarms.EMERGENCY_STOP
        controller.set_input(5, False)
        shop.step()
        assert shop.runner.acknowledge() == []
        controller.p[97] = 10  # left by a program whose kill was cleared elsewhere
        assert stop_all(other, shop.runner.settings).cause is None
    shop.close()
