"""Read a scenario file and refuse, with its place, everything that could not be played."""

from enum import Enum
from pathlib import Path
from typing import Any

from openacr.errors import SourceError
from openacr.plant.describe import toml_file
from openacr.plant.describe.explaining import explain
from openacr.plant.world.fault_kinds import MachineFault
from openacr.scenario.rules import STRUCT_OF_KEY, allowed_keys, problems
from openacr.scenario.schema import Key, Scenario, State

SECONDS = "_s"  # in names of times


def load_scenario(path: Path) -> Scenario:
    """Read and check the scenario file at `path`."""
    return parse_scenario(toml_file.read_text(path), str(path))


def parse_scenario(text: str, path: str = "scenario.toml") -> Scenario:
    """Check the text of a scenario; everything wrong is raised together, with its places."""
    raw = toml_file.parse(text, path)
    scenario, messages = toml_file.convert_all(raw, Scenario)
    found = [
        toml_file.wrong(text, path, where, "numbers have to be finite")
        for where in toml_file.not_finite(raw)
    ]
    found += [_wrong(message, raw, text, path) for message in messages]
    if scenario is not None and not found:
        found += [
            toml_file.wrong(text, path, each.steps, each.text, each.hint)
            for each in problems(scenario)
        ]
    toml_file.refuse(found)
    if scenario is None:
        raise toml_file.wrong(text, path, (), "it describes no scenario")
    return scenario


def _wrong(message: str, raw: dict[str, Any], text: str, path: str) -> SourceError:
    """Turn the converter's sentence about a path into one about a line."""
    what, where = toml_file.complaint_of(message)
    if unknown := toml_file.UNKNOWN.fullmatch(what):
        what, hint = f"unknown key `{unknown[1]}`", ", ".join(allowed_keys(where))
        return toml_file.wrong(text, path, (*where, unknown[1]), what, f"allowed: {hint}")
    if missing := toml_file.MISSING.fullmatch(what):
        return toml_file.wrong(text, path, where, f"`{missing[1]}` is missing")
    name = next((step for step in reversed(where) if isinstance(step, str)), "")
    if name.endswith(SECONDS):
        found = explain(message, raw, Scenario)
        return toml_file.wrong(text, path, where, f"{found.text} (seconds)")
    what = (what[:1].lower() + what[1:]).replace(" | null", "")  # TOML has no null
    return toml_file.wrong(text, path, where, f"{name}: {what}" if name else what, _choices(name))


def _choices(name: str) -> str:
    kinds: dict[str, type[Enum]] = {"key": Key, "state": State, "kind": MachineFault}
    if name in kinds:
        return "allowed: " + ", ".join(member.value for member in kinds[name])
    if name in STRUCT_OF_KEY:
        return "keys: " + ", ".join(allowed_keys([name]))
    return ""
