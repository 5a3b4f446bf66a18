"""A sweep file with a mistake: its line, the value, and what is allowed."""

from pathlib import Path

import pytest
from tests.sweep.projects import axis_project, formula_project, sweep_file

from openacr.errors import OpenacrError, SourceError
from openacr.sweep.load import load_sweep

GOOD = """[vary.a]
parameter = 0
values = [1]
[measures]
x = "at_end(P0)"
"""


def refused(file: Path) -> list[str]:
    with pytest.raises(OpenacrError) as error:
        load_sweep(file)
    found = error.value
    errors = found.errors if isinstance(found, SourceError) else (found,)
    return [str(each).replace(f"{file}:", "").replace(str(file.parent), "") for each in errors]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("values = [1]", "values = [", "5:2: invalid value"),
        ("values = [1]", "values = []", "4:1: a: values is empty"),
        ("values = [1]", 'values = ["x"]', '4:1: vary.a.values[0] is "x"; it must be a number'),
        ("values = [1]", "values = [nan]",
         "4:1: vary.a.values[0] is nan; it must be a finite number"),
        ("values = [1]", "value = [1]",
         "4:1: unknown key 'value' in [vary.a] (did you mean 'values'?)"),
        ("values = [1]", "range = [1]",
         "4:1: vary.a.range is [1]; it must be a list of 2 values, each a number"),
        ("values = [1]", "range = [2, 1]\nsteps = 3",
         "4:1: a: range is [2, 1]; the first value must be lower"),
        ("values = [1]", "range = [1, 1]\nsteps = 3",
         "4:1: a: range is [1, 1]; the first value must be lower"),
        ("values = [1]", "range = [1, 2]\nsteps = 1",
         "5:1: vary.a.steps is 1; it must be a whole number from 2 to 1000000"),
        ("values = [1]", "range = [1, 2]", "4:1: a: a range in a grid needs steps"),
        ("values = [1]", 'range = [0, 2]\nsteps = 3\nscale = "log"',
         '4:1: a: range begins at 0; with scale = "log" it must be above 0'),
        ("values = [1]", 'values = [1]\nscale = "log"', "5:1: a: scale belongs to range"),
        ("values = [1]", 'range = [1, 2]\nsteps = 3\nscale = "lin"',
         '6:1: vary.a.scale is "lin"; it must be one of "linear", "log"'),
        ("values = [1]", 'normal = [1, 0]\n[design]\nkind = "random"\nsamples = 2',
         "4:1: a: normal is [mean, sigma]; sigma is 0, it must be above 0"),
        ("values = [1]", "normal = [1, 2]", "4:1: a: normal is for random and sobol"),
        ("values = [1]", "values = [1]\nsteps = 3", "5:1: a: steps belongs to range"),
        ("values = [1]", "values = [1]\nrange = [1, 2]\nsteps = 2",
         "2:2: a needs one of values, range, normal; it has values and range"),
        ("parameter = 0", "",
         "2:2: a needs one of machine, parameter, define, line; it has none of them"),
        ("parameter = 0", 'line = "AXIS0 PGAIN 3"',
         '3:1: a: the line has no {} for the value: "AXIS0 PGAIN {}"'),
        ("parameter = 0", 'line = "AXIS0 PGIAN {}"', "2:2: a = 1: AXIS0 PGIAN 1: Unknown"),
        ("parameter = 0", "parameter = 50", "2:2: a = 1: P50 = 1: Undefined variable"),
        ("parameter = 0", "parameter = 99999999", "2:2: a = 1: P99999999 = 1: Invalid parameter"),
        ("parameter = 0", "parameter = 7040", "2:2: a = 1: P7040 = 1: P7040 is read-only"),
        ("parameter = 0", 'define = "MOST"',
         "2:2: a: no file of /p has a line `#DEFINE MOST ...`"),
        ("parameter = 0", 'machine = "AXIS0.load.inertia_kgm2"',
         "3:1: a: the project has no machine.toml"),
        ("[vary.a]", "[vary.A]",
         "2:2: 'A' cannot be a name (small letters, digits and _, a letter first, at most 40)"),
        ("[vary.a]", "[vary.status]",
         "2:2: status means something else in a sweep; choose another name"),
        ("x = ", "a = ", "6:1: a is a quantity and a measure; a name has one meaning"),
        ("at_end(P0)", "at_end(P50)",
         "5:2: P50: this card has no such parameter or flag (flags are 0..17663)"),
        ("at_end(P0)", "ever(BIT17664)",
         "5:2: BIT17664: this card has no such parameter or flag (flags are 0..17663)"),
        ("at_end(P0)", "AXIS8.distance", "5:2: AXIS8: the ACR9000 has AXIS0 to AXIS7"),
        ("at_end(P0)", "maxx(P0)", "6:1: x: there is no function 'maxx'"),
        ("[vary.a]", "until = 20000\n[vary.a]", "2:1: until is 20000: "),
        ("[vary.a]", "duration_s = 0\n[vary.a]",
         "2:1: duration_s is 0; it must be a number above 0 to 1e+07"),
        ("[vary.a]", "every_tk = 0\n[vary.a]",
         "2:1: every_tk is 0; it must be a whole number from 1 to 1000000"),
        ("[measures]", "[design]\nsamples = 3\n[measures]",
         "6:1: samples is for random and sobol"),
        ("[measures]", '[design]\nkind = "random"\n[measures]',
         '5:2: kind = "random" needs samples'),
        ("[measures]", '[design]\nkind = "sobol"\nsamples = 6\n[measures]',
         "7:1: samples is 6; of sobol it must be a power of 2 from 2 on"),
        ("[measures]", '[design]\nkind = "sobol"\nsamples = 1\n[measures]',
         "7:1: samples is 1; of sobol it must be a power of 2 from 2 on"),
        ("[measures]", '[design]\nkind = "random"\nsamples = 0\n[measures]',
         "7:1: design.samples is 0; it must be a whole number from 1 to 10000000"),
        ("[measures]", '[design]\nkind = "gird"\n[measures]',
         '6:1: design.kind is "gird"; it must be one of "grid", "list", "random", "sobol"'),
        ("[measures]", '[optimise]\nminimise = "y"\n[measures]',
         "6:1: minimise is 'y'; it must be a measure: x"),
        ("[measures]", "[optimise]\n[measures]", "5:2: [optimise] needs one of minimise, maximise"),
        ("[measures]", '[design]\n[optimise]\nminimise = "x"\n[measures]',
         "5:2: [design] and [optimise] exclude each other"),
        ('x = "at_end(P0)"\n', "", "5:2: [measures] is empty; a sweep needs at least one entry"),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_line_value_and_what_is_allowed(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    formula_project(tmp_path / "p")
    assert old in GOOD
    found = refused(sweep_file(tmp_path, GOOD.replace(old, new, 1)))
    assert len(found) == 1
    assert found[0].startswith(message), found[0]


@pytest.mark.parametrize(
    ("path", "values", "message"),
    [
        ("AXIS2.motor.inertia_kgm2", "[1e-5, -1]",
         "a = -1: axis[0].motor.inertia_kgm2 is -1; it must be a number above 0 to 1e+06"),
        ("AXIS2.motor.inertia", "[1]", "a = 1: unknown key 'inertia' in [axis.motor]"),
        ("AXIS0.motor.inertia_kgm2", "[1]", "a: the machine has no AXIS0; it has AXIS2"),
        ("wire[0].region", "[1]", "a = 1: wire[0].region is 1; it must be a table of axes"),
        ("wire[1].input", "[1]", "a: 'wire[1].input': the machine has no wire[1]"),
        ("inertia", "[1]", "a: 'inertia' is no place in a machine; AXIS0.load.inertia_kgm2 is one"),
        ("AXIS2.motor[x]", "[1]", "a: 'AXIS2.motor[x]' is no place in a machine"),
        ("AXIS2.travel[0]", "[1]", "a: 'AXIS2.travel[0]': the machine has no travel[0]"),
        ("AXIS2.number.x", "[1]", "a: 'AXIS2.number.x' is no place in a machine"),
    ],
)  # fmt: skip
def test_a_place_of_the_machine_is_checked_at_the_ends_of_its_values(
    tmp_path: Path, path: str, values: str, message: str
) -> None:
    axis_project(tmp_path / "p")
    text = f'[vary.a]\nmachine = "{path}"\nvalues = {values}\n[measures]\nx = "end_time"\n'
    (found,) = refused(sweep_file(tmp_path, text))
    assert found.startswith(f"2:2: {message}"), found


def test_several_places_of_the_machine_may_have_the_same_value(tmp_path: Path) -> None:
    axis_project(tmp_path / "p")
    text = (
        '[vary.a]\nmachine = ["AXIS2.motor.inertia_kgm2", "AXIS2.load.inertia_kgm2"]\n'
        'values = [3e-5]\n[vary.b]\nmachine = "AXIS2.encoder_lines"\nvalues = [500]\n'
        '[measures]\nx = "end_time"\n'
    )
    from openacr.sweep.targets import world_of

    world = world_of(load_sweep(sweep_file(tmp_path, text)), (3e-5, 500.0))
    assert world is not None
    (axis,) = world.axis
    assert axis.motor is not None
    assert (axis.motor.inertia_kgm2, axis.load.inertia_kgm2) == (3e-5, 3e-5)
    assert axis.encoder_lines == 500


@pytest.mark.parametrize(
    "text",
    [
        '[design]\nkind = "random"\nsamples = 3\n',
        '[design]\nkind = "random"\nsamples = 10000000\n',
        '[design]\nkind = "sobol"\nsamples = 2\n',
        '[design]\nkind = "sobol"\nsamples = 2097152\n',
        '[design]\nkind = "list"\n[vary.b]\nparameter = 1\nvalues = [2]\n',
        "[vary.b]\nparameter = 1\nrange = [0, 1]\nsteps = 10000\n"
        "[vary.c]\nparameter = 2\nrange = [0, 1]\nsteps = 1000\n",
    ],
)
def test_designs_at_the_ends_of_what_is_allowed_are_taken(tmp_path: Path, text: str) -> None:
    formula_project(tmp_path / "p")
    study = load_sweep(sweep_file(tmp_path, text + GOOD))
    assert "a" in study.quantities


def test_sobol_counts_the_runs_that_its_samples_make(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    text = '[design]\nkind = "sobol"\nsamples = 4194304\n'
    (found,) = refused(sweep_file(tmp_path, text + GOOD))
    assert found == "4:1: 12582912 runs; at most 10000000"


def test_lists_of_a_list_design_are_equally_long(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    text = '[design]\nkind = "list"\n[vary.b]\nparameter = 1\nvalues = [1, 2]\n'
    (found,) = refused(sweep_file(tmp_path, text + GOOD))
    assert found.endswith("the quantities of a list have as many values each; found: b 2, a 1")


def test_a_grid_beyond_ten_million_runs_is_refused(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    wide = "".join(
        f"[vary.{name}]\nparameter = {n}\nrange = [0, 1]\nsteps = 1000\n"
        for n, name in enumerate("bcd")
    )
    (found,) = refused(sweep_file(tmp_path, wide + GOOD))
    assert "1000000000 runs; at most 10000000" in found


def test_everything_wrong_is_named_together(tmp_path: Path) -> None:
    formula_project(tmp_path / "p")
    text = GOOD.replace("values = [1]", "steps = 1\nvalue = 3").replace("[measures]", "[measure]")
    assert len(refused(sweep_file(tmp_path, text))) == 4


def test_a_project_with_a_refused_line_is_refused_with_its_line(tmp_path: Path) -> None:
    project = formula_project(tmp_path / "p")
    (project / "prog0.8k").write_text("PROGRAM\nGOTI 5\nENDP\n")
    (found,) = refused(sweep_file(tmp_path, GOOD))
    assert found.startswith("/p/prog0.8k:2")


def test_a_missing_project_is_named(tmp_path: Path) -> None:
    (found,) = refused(sweep_file(tmp_path, GOOD))
    assert found == "/p: no such file or folder"
