"""Positions of the machine taken over as offsets."""

from collections.abc import Callable
from pathlib import Path

import pytest
from tests.mill.shop import Shop
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.errors import UserError
from openacr.mill.manual.teaching import teach
from openacr.mill.session import MillSession
from openacr.sysvar import Store
from openacr.sysvar.tabs import CELLS


def standing(**cells: float) -> Shop:
    shop = Shop(**cells)
    shop.run_text("G90 G53 F600\nG1 X2 Y3 Z-1\nM2\n")
    return shop


def taught(shop: Shop, code: str, axes: list[int]) -> None:
    runner = shop.runner
    teach(shop.store, runner.settings, code, runner.stream.host.position(), axes)


@pytest.mark.req("MILL-WCS-TEACH")
@pytest.mark.parametrize("code", ["G54", "G57", "G59.2"])
def test_the_machine_position_becomes_the_zero_of_a_work_system(code: str) -> None:
    shop = standing(P900=0.5)  # a common shift of X
    taught(shop, code, [0, 1])
    shop.run_text(f"G90 {code} F600\nG1 X0 Y0\nM2\n")
    assert shop.pulses() == (20000, 30000, -10000)  # it stands there already
    shop.run_text(f"G90 {code} F600\nG1 X1 Z0\nM2\n")
    assert shop.pulses() == (30000, 30000, 0)  # Z was not taught


@pytest.mark.req("MILL-WCS-TEACH")
def test_the_command_teaches_the_axes_it_is_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shop = standing(P280=0.0)
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "sysvar.db"))
    with Store(tmp_path / "sysvar.db") as store:
        store.write(271, 7)

    def real(_target: str, cells: Store, say: Callable[[str], None]) -> MillSession:
        return MillSession(shop.card, cells, say, is_virtual=False)

    monkeypatch.setattr(MillSession, "real", real)
    words = ["mill", "teach", "g55", "--axes", "XZ", "--host", "somewhere"]
    result = CliRunner().invoke(app, words)
    assert result.output == "G55: X Z read 0 here\n"
    with Store(tmp_path / "sysvar.db") as store:
        assert [store.read(920 + axis) for axis in range(3)] == [2.0, 0.0, -1.0]


def test_an_axis_that_is_not_homed_cannot_be_taught() -> None:
    shop = standing()
    other = Shop(P201_007=1)
    with pytest.raises(UserError, match="axis Y is not homed"):
        taught(other, "G54", [0, 1])
    assert other.store.read(910) == 0.0
    with pytest.raises(UserError, match="G60: work systems are G54"):
        taught(shop, "G60", [0])


def test_a_rotated_system_is_taught_along_its_own_axes() -> None:
    shop = standing()
    store, settings = shop.store, shop.runner.settings
    code, here = "G55", (3.0, 4.0, 0.0, 0, 0, 0, 0, 0)
    cells, angle = CELLS.work_systems[1], CELLS.work_rotations[1]
    store.write(angle, 90.0)
    teach(store, settings, code, here, [0, 1])
    assert [store.read(cell) for cell in cells[:3]] == [3.0, 4.0, 0.0]
    store.write(cells[0], 1.0)
    store.write(cells[1], 2.0)  # here reads X2 Y-2
    teach(store, settings, code, here, [0])
    assert [store.read(cell) for cell in cells[:2]] == [1.0, 4.0]  # X0 Y-2
    teach(store, settings, code, here, [2])
    assert [store.read(cell) for cell in cells[:2]] == [1.0, 4.0]
