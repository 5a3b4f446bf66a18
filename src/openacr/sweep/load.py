"""Read a sweep file; errors give the line, the value and the permitted values."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from openacr.errors import SourceError, UserError, read_bytes
from openacr.plant.describe import toml_file
from openacr.plant.describe.complaint import Complaint
from openacr.plant.describe.explaining import explain, not_finite
from openacr.project import Project, find_project
from openacr.scenario import Scenario, parse_scenario
from openacr.scenario.course import LONGEST_S, Until, read_until
from openacr.sweep import rules, trial
from openacr.sweep.schema import Design, Head, Tables, kind_for, tables_of
from openacr.sweep.study import Study

NO_SCENARIO = "none"


def load_sweep(path: Path) -> Study:
    """Read and check a sweep; its first point is loaded, and the ends of each quantity tried.

    Raises SourceError with all that is wrong in the file, or what is wrong with its project.
    """
    text = toml_file.read_text(path)
    found, tables = parse_sweep(text, str(path))
    project = find_project(path.parent / found.project)
    scenario, scenario_text = _scenario(path.parent, project, found.scenario)
    until, limit_s = _end(text, str(path), found, scenario)
    study = Study(
        project=project,
        machine=toml_file.read_text(project.machine) if project.machine else None,
        devices=_device_files(project),
        scenario=scenario,
        scenario_text=scenario_text,
        limit_s=limit_s,
        until=until,
        every_tk=found.every_tk,
        quantities=tables.vary,
        measures=tables.measures,
        design=found.design or Design(),
        optimise=found.optimise,
    )
    toml_file.refuse(_placed(text, str(path), trial.problems(study)))
    return study


def parse_sweep(text: str, path: str = "sweep.toml") -> tuple[Head, Tables]:
    """Check the text of a sweep; everything wrong is raised together, with its places."""
    raw = toml_file.parse(text, path)
    kind = kind_for(raw)
    found, messages = toml_file.convert_all(raw, kind)
    complaints = list(not_finite(raw))
    if not complaints:
        complaints = [explain(message, raw, kind) for message in messages]
    if found is not None and not complaints:
        complaints = list(rules.problems(found, tables_of(found)))
    toml_file.refuse(_placed(text, path, complaints))
    if found is None:
        raise toml_file.wrong(text, path, (), "it describes no sweep")
    return found, tables_of(found)


def _placed(text: str, path: str, complaints: list[Complaint]) -> Iterator[SourceError]:
    return (toml_file.wrong(text, path, each.path, each.text, each.hint) for each in complaints)


def _device_files(project: Project) -> tuple[bytes, ...]:
    """The Python files beside machine.toml: what they say decides results, too."""
    if project.machine is None:
        return ()
    return tuple(map(read_bytes, sorted(project.machine.parent.glob("*.py"))))


def _scenario(folder: Path, project: Project, named: str | None) -> tuple[Scenario | None, str]:
    """The scenario of the runs with its text: the one named, else that of the project."""
    if named == NO_SCENARIO:
        return None, ""
    path = folder / named if named else project.scenario
    if path is None:
        return None, ""
    text = toml_file.read_text(path)
    return parse_scenario(text, str(path)), text


def _end(
    text: str, path: str, found: Head, scenario: Scenario | None
) -> tuple[Until | None, float]:
    """When a run ends: as `openacr run` ends it with --until and --for."""
    until: Until | None = None
    if found.until is not None:
        try:
            until = read_until(str(found.until))
        except UserError as error:
            raise toml_file.wrong(
                text, path, ("until",), f"until is {found.until}: {error}"
            ) from None
    limit_s = found.duration_s or (scenario.duration_s if scenario else None)
    if until is None and limit_s is None:
        until = Until()
    return until, limit_s or LONGEST_S
