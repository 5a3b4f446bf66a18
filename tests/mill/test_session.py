"""Start-up: the card, its model, what is reset, and that nothing moves by itself."""

import pytest
from tests.mill.shop import Shop

from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.map.numbers import P_FIRMWARE_VERSION
from openacr.map.words import af4
from openacr.mill.config.settings import HOMED
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS

CARD_MODEL = 100_002


def shop_on(controller: Controller, **cells: float) -> MillSession:
    store = Store()
    for name, value in cells.items():
        store.write(int(name.removeprefix("P")), value)
    return MillSession.real(controller, store, say=lambda _text: None)


def finish(shop: MillSession) -> None:
    while shop.runner.is_busy:
        shop.step()


@pytest.mark.req("MILL-START-CHECK")
def test_a_card_that_answers_takes_commands_at_once() -> None:
    controller = Controller()
    shop = shop_on(controller, P200_007=0)
    shop.card.command("DRIVE ON X Y Z", program=0)
    assert controller.time_s < 5.0
    places = list(shop.run_blocks(["G91 F600 G1 X0.5"], "acromill", lambda _shop: None))
    assert places[0][0] == 0.5
    assert controller.axis(0).actual_cnt == pytest.approx(5000, abs=3)


@pytest.mark.req("MILL-START-FWVER")
def test_a_card_older_than_1_18_is_refused() -> None:
    controller = Controller()
    controller.memory.I[P_FIRMWARE_VERSION] = 11799
    with pytest.raises(UserError, match=r"alarm 2: Firmware older than 1\.18: 1\.17\.99$"):
        shop_on(controller)
    controller.memory.I[P_FIRMWARE_VERSION] = 11800
    shop_on(controller)


@pytest.mark.req("MILL-START-SERVOSAFE")
def test_nothing_is_enabled_and_nothing_moves_at_the_start_with_defaults() -> None:
    controller = Controller()
    shop = shop_on(controller)
    for _ in range(100):
        shop.step()
    axes = range(controller.model.axes)
    assert not any(controller.memory.I[af4.word[axis]] & af4.DRIVE_ENABLED for axis in axes)
    assert {controller.axis(axis).actual_cnt for axis in axes} == {0}


@pytest.mark.req("MILL-OV-CONTROLLERS")
@pytest.mark.parametrize("model", ["ACR1200", "ACR1500", "ACR2000", "ACR8010", "ACR8020"])
def test_the_virtual_machine_is_of_the_model_of_the_store(model: str) -> None:
    store = Store()
    store.write_text(CARD_MODEL, model)
    store.write(AXIS.configured[2], 0)
    shop = MillSession.virtual(store, say=lambda _text: None)
    assert shop.card.command("VER") == [f"{model} Version 1.18.06 Update 15"]
    shop.start(load("F100 G1 X1 Y1\nG2 X2 Y0 I1 J0\nM2\n", shop.cells), Start())
    finish(shop)
    assert shop.runner.stream.host.position()[:2] == pytest.approx((2.0, 0.0), abs=1e-4)


def test_more_axes_than_the_model_has_are_refused() -> None:
    store = Store()
    store.write_text(CARD_MODEL, "ACR1200")
    with pytest.raises(UserError, match=r"alarm 4: .*ACR1200: axis Z, it has 2 axes"):
        MillSession.virtual(store)


def test_a_machine_that_another_program_moves_is_left_alone() -> None:
    running = Shop()
    running.load("F60\nG1 X10\nM2\n")
    running.pass_time(0.5)
    with pytest.raises(UserError, match="the machine is moving"):
        MillSession.real(running.controller, Store(), say=print)
    assert running.until(State.IDLE) is State.IDLE
    assert running.pulses()[0] == 100_000


@pytest.mark.req("MILL-MDI-BUSY")
def test_mdi_is_refused_while_a_program_runs() -> None:
    store = Store()
    store.write(HOMED, 255)
    shop = MillSession.virtual(store, say=lambda _text: None)
    shop.start(load("F60 G1 X1\nM2\n", shop.cells), Start())
    shop.step()
    with pytest.raises(UserError, match="cannot start a program: the state is RUN"):
        list(shop.run_blocks(["G0 Y1"], "acromill", lambda _shop: None))
    finish(shop)
    assert shop.runner.stream.host.position()[:2] == (1.0, 0.0)


@pytest.mark.req("MILL-MDI-TOPROG")
def test_what_was_typed_is_a_program() -> None:
    shop = MillSession.virtual(Store(), say=lambda _text: None)
    list(shop.run_blocks(["G90 F600", "G1 X1", "G91 Y0.5"], "acromill", lambda _shop: None))
    assert shop.typed == ["G90 F600", "G1 X1", "G91 Y0.5"]
    again = MillSession.virtual(Store(), say=lambda _text: None)
    again.start(load("\n".join(shop.typed), again.cells), Start())
    finish(again)
    assert again.runner.stream.host.position()[:2] == (1.0, 0.5)


def test_the_block_of_a_long_path_is_shown_with_its_text() -> None:
    shop = MillSession.virtual(Store(), say=lambda _text: None)
    text = "G1 F60\n" + "".join(f"X{0.1 * n:.1f} Y0\n" for n in range(1, 31)) + "M2\n"
    shop.start(load(text, shop.cells), Start())
    while shop.block is None or shop.block[0] < 12:
        shop.step()
    assert shop.block == (12, "X1.1 Y0")


PART = "G0 Z1\nS800 M3\nM7 M8\nG1 X1 F600\nX2\nM2\n"


@pytest.mark.req("MILL-RUN-STARTLINE-STATE")
@pytest.mark.parametrize(
    ("typed", "differs"),
    [
        ("M5", {"S": ("0", "800"), "spindle": ("off", "clockwise")}),
        ("S800 M3", {}),
        ("S800 M4", {"spindle": ("counter-clockwise", "clockwise")}),
        ("S800 M4\nM5", {"spindle": ("off", "clockwise")}),
        ("S300 M3", {"S": ("300", "800")}),
        ("S800 M3\nM8", {"coolant": ("flood", "mist and flood")}),
        ("S800 M3\nM7", {"coolant": ("mist", "mist and flood")}),
        ("S800 M3\nM7\nM8", {"coolant": None}),
    ],
)
def test_a_start_at_a_line_compares_with_what_the_machine_has_switched_on(
    typed: str, differs: dict[str, tuple[str, str] | None]
) -> None:
    shop = shop_on(Controller(), P200_007=0)
    shop.card.command("DRIVE ON X Y Z", program=0)
    list(shop.run_blocks(typed.splitlines(), "acromill", lambda _shop: None))
    replay = shop.rehearse(load(PART, shop.cells), Start(line=5))
    found = {
        each.name: (each.shown(each.present), each.shown(each.wanted))
        for each in replay.differences
        if each.name in ("S", "spindle", "coolant")
    }
    assert found == {
        name: pair
        for name, pair in {"coolant": ("off", "mist and flood"), **differs}.items()
        if pair is not None
    }
