"""Reference points of the OFFSETS tab: entered by axis, kept, approached by G27 to G30."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, CELLS, IO

POINTS = {  # by number: the first cell, and where X, Y and Z are
    1: (280, (1.0, 2.0, 0.5)),
    2: (290, (-1.25, 0.25, 0.75)),
    3: (300, (3.0, -2.0, 1.5)),
    4: (310, (0.125, 4.0, -0.5)),
}
CONFIRMED, HOMED = 15, 248


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A store into which the points were entered by a process that has ended."""
    path = tmp_path / "sysvar.db"
    words = [
        f"P{first + axis}={value}"
        for first, point in POINTS.values()
        for axis, value in enumerate(point)
    ]
    for word in words:
        name, _, value = word.partition("=")
        result = CliRunner().invoke(app, ["sysvar", "set", "--store", str(path), f"{name}={value}"])
        assert result.exit_code == 0, result.output
    return path


def ends(path: Path, text: str) -> tuple[float, ...]:
    """Where X, Y and Z end; the switch of G27 is closed at point 1 alone."""
    controller = Controller()
    for axis in range(3):
        controller.bit[HOMED + axis] = True
    with Store(path) as store:
        for axis in range(3):
            store.write(AXIS.home_required[axis], 0)
        store.write(CELLS.homed_axes, 7)
        store.write(IO.g27_input, CONFIRMED)
        session = MillSession.real(controller, store, lambda _text: None)
        session.card.command("DRIVE ON X Y Z", program=0)
        session.start(load(text, session.cells), Start())
        while session.runner.is_busy:
            session.step()
            is_there = place(controller) == pytest.approx(POINTS[1][1], abs=1e-4)
            controller.set_input(CONFIRMED, is_there)
        assert session.runner.alarms.active == []
        session.close()
    return place(controller)


def place(controller: Controller) -> tuple[float, ...]:
    return tuple(float(controller.p[12288 + 256 * axis]) / 1e4 for axis in range(3))


@pytest.mark.req("MILL-OFS-REFPT")
def test_each_point_has_its_cells_below_p400_axis_by_axis(path: Path) -> None:
    cells = (CELLS.reference_point_1, CELLS.reference_point_2, CELLS.reference_point_3,
             CELLS.reference_point_4)  # fmt: skip
    assert [(each[0], each[7]) for each in cells] == [
        (280, 287), (290, 297), (300, 307), (310, 317),
    ]  # fmt: skip
    with Store(path) as store:
        for cell, (_, point) in zip(cells, POINTS.values(), strict=True):
            assert tuple(store.read(cell[axis]) for axis in range(3)) == point


@pytest.mark.req("MILL-OFS-REFPT")
@pytest.mark.parametrize(
    ("text", "end"),
    [
        ("G28 X0 Y0 Z0", POINTS[1][1]),
        ("G28 Y0", (0.0, 2.0, 0.0)),
        ("G27 X5 Y6 Z.1", (5.0, 6.0, 0.1)),  # at point 1 in between, which its input confirms
        ("G30 X0 Y0 Z0", POINTS[2][1]),
        ("G30 P2 Z0", (0.0, 0.0, 0.75)),
        ("G30 P3 X0 Y0 Z0", POINTS[3][1]),
        ("G30 P4 X0 Y0 Z0", POINTS[4][1]),
        ("G28 X.5 Y.5 Z.5\nG29 X4 Y5 Z.25", (4.0, 5.0, 0.25)),
    ],
)
def test_the_codes_go_to_the_points_of_the_store(
    path: Path, text: str, end: tuple[float, ...]
) -> None:
    assert ends(path, f"G90\n{text}\nM2\n") == pytest.approx(end, abs=1e-4)
