"""What `openacr new` makes has no errors, runs and meets its scenario, whatever was chosen."""

import itertools
import tomllib
from pathlib import Path
from typing import Any

import pytest
from tests.search import sparse
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.configure import code_files, parse_answers
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.card.setup import MOVES
from openacr.plant.describe.load import load_world
from openacr.source_check import check
from openacr.starter.choices import KINDS, Choices, Homing, Kind, Limits, Unit, choices
from openacr.starter.files import project_files, write_project

INPUTS: tuple[tuple[str, ...], ...] = ((), ("start", "door"))
ALL_INPUTS = ("start", "door", "air")


def made(folder: Path, chosen: Choices) -> Path:
    write_project(folder / "machine", chosen)
    return folder / "machine"


def require_good(project: Path) -> None:
    """No fault at all, not even a warning, and every expectation is met."""
    assert [str(fault) for fault in check(project)] == []
    result = CliRunner().invoke(app, ["run", str(project)])
    assert result.exit_code == 0, result.output
    assert "cycle 1 done" in result.stdout
    met = result.stderr.split(" expectations met")[0].split()
    assert met[-3] == met[-1] != "0"


# Every kind is there with all limits, homings, inputs and with and without a PLC: one of seven.
COMBINATIONS = sparse(list(itertools.product(Kind, Limits, Homing, INPUTS, (False, True))), 7)


@pytest.mark.parametrize(("kind", "limits", "homing", "inputs", "has_plc"), COMBINATIONS)
def test_every_combination_runs_and_meets_its_scenario(
    tmp_path: Path,
    kind: Kind,
    limits: Limits,
    homing: Homing,
    inputs: tuple[str, ...],
    has_plc: bool,
) -> None:
    chosen = choices(kind, limits=limits, homing=homing, inputs=inputs, has_plc=has_plc)
    require_good(made(tmp_path, chosen))


@pytest.mark.parametrize("kind", Kind)
@pytest.mark.parametrize("unit", Unit)
def test_every_unit_makes_the_same_machine(tmp_path: Path, kind: Kind, unit: Unit) -> None:
    require_good(made(tmp_path, choices(kind, unit=unit, inputs=("start",))))


@pytest.mark.parametrize("kind", Kind)
@pytest.mark.parametrize("travel_rev", [4.0, 5.3])
def test_a_short_travel_has_room_for_switches_and_work(
    tmp_path: Path, kind: Kind, travel_rev: float
) -> None:
    chosen = choices(kind, unit=Unit.MM, travel_u=5.0 * travel_rev, limits=Limits.BOTH)
    require_good(made(tmp_path, chosen))


@pytest.mark.parametrize("kind", Kind)
def test_eight_axes_are_made_homed_and_moved(tmp_path: Path, kind: Kind) -> None:
    axes = ("X", "Y", "A", "B", "C", "U", "V", "LIFT")
    require_good(
        made(
            tmp_path, choices(kind, axes=axes, limits=Limits.BOTH, inputs=ALL_INPUTS, has_plc=True)
        )
    )


def test_the_tool_axis_of_a_gantry_has_its_zero_at_the_top() -> None:
    world = tomllib.loads(project_files("g", choices(Kind.GANTRY))["machine.toml"])
    x, _, z = world["axis"]
    assert (x["travel"], x["initial"]) == ([-12.5, 212.5], 100)
    assert (z["travel"], z["initial"]) == ([-212.5, 12.5], -100)
    assert (x["home"]["between"], z["home"]["between"]) == ([-12.5, -2.5], [2.5, 12.5])
    assert (x["positive_limit"]["at"], x["negative_limit"]["at"]) == (207.5, -7.5)
    assert (z["positive_limit"]["at"], z["negative_limit"]["at"]) == (7.5, -207.5)
    program = project_files("g", choices(Kind.GANTRY))["prog0.8k"]
    assert "JOG HOME Z1 " in program and "JOG HOME X-1 " in program
    assert "MSEEK Z(-5.25,0)" in program and "MSEEK X(5.25,0)" in program


def test_a_gantry_of_two_axes_has_no_tool_axis() -> None:
    world = tomllib.loads(project_files("g", choices(Kind.GANTRY, axes=("X", "Y")))["machine.toml"])
    assert [axis["travel"] for axis in world["axis"]] == [[-12.5, 212.5]] * 2


@pytest.mark.parametrize("kind", Kind)
def test_every_line_is_explained(kind: Kind) -> None:
    files = project_files("m", choices(kind, limits=Limits.BOTH, inputs=ALL_INPUTS, has_plc=True))
    for name, text in files.items():
        mark = {".8k": "REM ", ".toml": "# "}.get(Path(name).suffix)
        if mark is None or name == "prog15.8k":  # which holds nothing but remarks
            continue
        before = ""
        for line in text.splitlines():
            assert not line or mark in line or before.startswith(mark), f"{name}: {line}"
            before = line


def test_the_set_up_is_what_configure_makes_of_the_answers() -> None:
    files = project_files("m", choices(Kind.MILL, has_plc=True))
    answers = files["configure.toml"]
    made = code_files(parse_answers(answers), answers, is_explained=True)
    assert made == {name: files[name] for name in ("setup.8k", "prog15.8k")}
    assert "DIM PLC0(4096) : REM " in files["setup.8k"]


CUT = {"kind": Kind.MILL, "unit": Unit.MM, "homing": Homing.MARKER, "axes": ("X", "Y", "Z")}


@pytest.mark.parametrize(
    ("other", "has_part"),
    [
        ({}, True),
        ({"unit": Unit.INCH}, True),
        ({"unit": Unit.DEGREE}, False),
        ({"homing": Homing.SWITCH}, False),
        ({"axes": ("X", "Y", "W")}, False),
        ({"axes": ("X", "Y")}, False),
        ({"kind": Kind.GANTRY}, False),
    ],
)
def test_a_mill_the_cnc_side_can_use_has_settings_and_a_part(
    tmp_path: Path, other: dict[str, Any], has_part: bool
) -> None:
    project = made(tmp_path, choices(**{**CUT, **other}))
    assert {"settings.toml", "part.nc"} <= {path.name for path in project.iterdir()} or not has_part
    assert (project / "part.nc").exists() == (project / "settings.toml").exists() == has_part
    if has_part:
        store = str(tmp_path / "sysvar.db")
        settings = str(project / "settings.toml")
        stored = CliRunner().invoke(app, ["sysvar", "import", settings, "--store", store])
        assert stored.stdout == "64 settings stored\n"
        words = ["mill", "check", str(project / "part.nc"), "--store", store, "--json"]
        checked = CliRunner().invoke(app, words)
        assert checked.exit_code == 0, checked.output


def test_the_part_is_the_contour_of_the_program() -> None:
    files = project_files("m", choices(Kind.MILL, limits=Limits.SWITCHES))
    for target in ("X50 Y50", "Z-100", "X100", "X0 Y0"):
        assert f"\n{target} : REM" in files["prog0.8k"]
        assert f" {target}" in files["part.nc"]
    assert "CIRCCW X(100,100) Y(100,75)" in files["prog0.8k"]
    assert "G3 X100 Y100 I0 J25\n" in files["part.nc"]
    assert "P200002 = true " in files["settings.toml"]  # no soft limits were chosen
    assert [f"P30{n}000 = {d}  " in files["settings.toml"] for n, d in enumerate((1, 1, 0))] == [
        True, True, True,
    ]  # fmt: skip


def test_a_turntable_without_limits_has_no_stops(tmp_path: Path) -> None:
    world = load_world(made(tmp_path, choices(Kind.TURNTABLE)) / "machine.toml")
    assert world.axis[0].travel is None
    assert world.axis[0].home is not None


def test_a_door_that_is_open_keeps_the_cycle_from_starting(tmp_path: Path) -> None:
    project = made(tmp_path, choices(Kind.AXIS, inputs=("start", "door")))
    scenario = project / "scenario.toml"
    text = scenario.read_text()
    assert "set = [25]" in text
    scenario.write_text(text.replace("set = [25]", "clear = [25]"))
    result = CliRunner().invoke(app, ["run", str(project)])
    assert result.exit_code == 1
    assert "ready" in result.stdout and "cycle 1 done" not in result.stdout


def test_a_button_that_is_held_starts_one_cycle_only(tmp_path: Path) -> None:
    project = made(tmp_path, choices(Kind.AXIS, inputs=("start",)))
    scenario = project / "scenario.toml"
    scenario.write_text(scenario.read_text().replace("press = [24]", "set = [24]"))
    result = CliRunner().invoke(app, ["run", str(project), "--for", "60"])
    assert "cycle 1 done" in result.stdout and "cycle 2 done" not in result.stdout


def test_a_machine_whose_switch_is_missing_says_so_and_does_not_move_on(tmp_path: Path) -> None:
    project = made(tmp_path, choices(Kind.AXIS))
    machine = project / "machine.toml"
    text = machine.read_text()
    start = text.index("[axis.home]")
    machine.write_text(text[:start])
    result = CliRunner().invoke(app, ["run", str(project)])
    assert result.exit_code == 1
    assert "not homed" in result.stdout and "ready" not in result.stdout


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"axes": ("X", "X")}, "--axes: X is there twice"),
        ({"axes": ("X1",)}, "--axes: 'X1' is no name of an axis"),
        ({"axes": ("P",)}, "--axes: 'P' is no name of an axis"),
        ({"axes": tuple("ABCUVWXYZ")}, "--axes: 9 given; a axis has 1 to 8 of them"),
        ({"travel_u": 19.9}, "--travel: 19.9 mm; give 20 to 10000 mm"),
        ({"travel_u": 10000.1}, "--travel: 10000.1 mm; give 20 to 10000 mm"),
        ({"travel_u": float("nan")}, "--travel: nan mm; give 20 to 10000 mm"),
        ({"inputs": tuple("abcdefghi")}, "--inputs: 9 given; 8 inputs are free"),
        ({"inputs": ("start", "start")}, "--inputs: start is there twice"),
        ({"inputs": ('a"b',)}, "--inputs: 'a\"b' is no name of an input"),
    ],
)
def test_a_choice_that_cannot_be_is_refused_with_its_option(
    options: dict[str, object], said: str
) -> None:
    with pytest.raises(UserError) as refused:
        choices(Kind.AXIS, **options)  # type: ignore[arg-type]
    assert str(refused.value).startswith(said.replace("a axis", "the kind axis"))


@pytest.mark.parametrize("kind", [Kind.GANTRY, Kind.MILL])
def test_a_kind_that_works_in_a_plane_needs_two_axes(kind: Kind) -> None:
    with pytest.raises(UserError, match=f"1 given; the kind {kind} has 2 to 8 of them"):
        choices(kind, axes=("X",))


def test_what_is_not_chosen_comes_from_the_kind() -> None:
    for kind, row in KINDS.items():
        chosen = choices(kind)
        found = (chosen.axes, chosen.unit, chosen.limits, chosen.homing)
        assert found == (row.axes, row.unit, row.limits, row.homing)
        assert (chosen.inputs, chosen.has_plc) == ((), False)


def test_a_machine_for_part_programs_has_memory_for_the_moves_that_the_cnc_side_buffers() -> None:
    chosen = choices(Kind.MILL, axes=("X", "Y", "Z"), homing=Homing.MARKER)
    card = Controller()
    for line in project_files("m", chosen)["setup.8k"].splitlines():
        card.send(f"{line}\r")
    assert f"DIM MBUF({MOVES})" in card.send(f"PROG0\rDIM MBUF({MOVES})\rDIM\r")
    assert f"\nDIM MBUF({MOVES})" in card.send("DIM\r").replace("\r", "")
