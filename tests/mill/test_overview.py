"""What the machine as a whole promises: axes, wiring by number, PLCs beside programs."""

import pytest
from tests.mill.shop import Shop

from openacr.cnc.loading.load import load
from openacr.cnc.parts.library import part_named, prepared
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS

ESTOP = "P400_004"


def eight_axes() -> Store:
    store = Store()
    for axis in range(8):
        store.write(AXIS.configured[axis], 1)
    return store


def ends(store: Store, text: str) -> tuple[float, ...]:
    shop = MillSession.virtual(store, say=lambda _text: None)
    shop.start(load(text, shop.cells), Start())
    while shop.runner.is_busy:
        shop.step()
    assert shop.runner.alarms.active == []
    return shop.runner.stream.host.position()


@pytest.mark.req("MILL-OV-LETTERS")
def test_letters_address_the_axes_in_their_order_and_can_be_renamed() -> None:
    store = eight_axes()
    text = "G90 F600\nG1 X.1 Y.2 Z.3 A4 B5 C6 U.7 V.8\nM2\n"
    assert ends(store, text) == pytest.approx((0.1, 0.2, 0.3, 4, 5, 6, 0.7, 0.8), abs=1e-4)
    with store.transaction():
        store.write_text(AXIS.name[0], "V")
        store.write_text(AXIS.name[7], "X")
    assert ends(store, text) == pytest.approx((0.8, 0.2, 0.3, 4, 5, 6, 0.7, 0.1), abs=1e-4)


@pytest.mark.req("MILL-OV-PLC")
def test_a_plc_scans_as_often_while_a_program_runs() -> None:
    def scans(text: str) -> int:
        shop = Shop(P650_000=6000.0)
        for line in ("PLC0", "LD NOT BIT128", "OUT BIT128", "RUN"):
            shop.controller.send(line)
        before, toggles = shop.controller.bit[128], 0
        shop.load(text)
        for _ in range(200):
            shop.pass_time(0.005)
            toggles += shop.controller.bit[128] != before
            before = shop.controller.bit[128]
        return toggles

    busy = "F3000\n" + "".join(f"G1 X{n % 2} Y{n % 3}\n" for n in range(400)) + "M2\n"
    assert scans(busy) == scans("G4 F5\nM2\n")


@pytest.mark.req("MILL-OV-IOASSIGN")
@pytest.mark.parametrize(("bound", "active", "state"), [
    (5, 5, State.ALARM), (9, 9, State.ALARM), (5, 9, State.RUN), (-1, 5, State.RUN),
])  # fmt: skip
def test_functions_are_bound_to_inputs_by_their_number_alone(
    bound: int, active: int, state: State
) -> None:
    shop = Shop(**{ESTOP: float(bound)})
    shop.load("F60\nG1 X5\nM2\n")
    shop.pass_time(0.2)
    shop.controller.set_input(active, True)
    shop.pass_time(0.2)
    assert shop.runner.state is state


@pytest.mark.req("MILL-OV-EIA")
def test_files_parts_and_mdi_speak_the_same_language() -> None:
    blocks = ["G91 F60", "G1 X(0.5*2) Y.5", "G2 X1 Y0 I1.5 J.5", "G90"]
    by_file = ends(Store(), "\n".join(blocks))
    shop = MillSession.virtual(Store(), say=lambda _text: None)
    *_, by_mdi = shop.run_blocks(blocks, "acromill", lambda _shop: None)
    assert by_mdi == by_file == pytest.approx((2.0, 0.5, 0, 0, 0, 0, 0, 0), abs=1e-4)
    part = prepared(part_named("CIRCLE"), {}, Store(), is_metric=False, feed=200.0).program
    assert load(part, Store()).errors == []
    drilled = ends(Store(), part)
    assert drilled == pytest.approx(ends(Store(), f"G0 X0\n{part}"), abs=1e-4)
