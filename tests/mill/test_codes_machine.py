"""M codes, reference points, probing and parameters of the card on the virtual machine."""

import pytest
from tests.mill.shop import Shop

from openacr.sysvar import Store
from openacr.sysvar.values import SettingError

# --- parameters of the card ---------------------------------------------------------------


@pytest.mark.req("MILL-P-0-33", "MILL-P-34-99", "MILL-P-NONPERSIST")
def test_p0_to_p33_are_variables_of_the_card_and_go_with_its_power() -> None:
    shop = Shop()
    shop.run_text("P0=1.5\nP33=P0*2\nP34=2.5\nP89=P34*2\nG1 F600 X(P33)\nM2\n")
    assert [shop.controller.p[k] for k in (0, 33, 34, 89)] == [1.5, 3.0, 2.5, 5.0]
    assert shop.pulses()[0] == 30_000
    shop.controller.send("SYS\rREBOOT\r")
    again = Shop.on(shop.controller, {})
    assert [again.controller.p[k] for k in (0, 33, 34, 89)] == [0.0] * 4


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
