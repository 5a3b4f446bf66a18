"""What the machine as a whole promises: axes, wiring by number, PLCs beside programs."""

import pytest
from tests.mill.shop import Shop

from openacr.cnc.loading.load import load
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS


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
def test_two_axes_may_have_each_other_s_letters() -> None:
    store = eight_axes()
    text = "G90 F600\nG1 X.1 Y.2 Z.3 A4 B5 C6 U.7 V.8\nM2\n"
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
