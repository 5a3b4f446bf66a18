"""Every golden file, and every test beside an oracle, says what its expectation rests on."""

import ast
import re
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

TESTS = Path(__file__).parent
KINDS = {"manual", "oracle", "client", "reading"}
ORACLES = {"scipy", "shapely", "ruckig"}
ORACLE_MODULES = ("oracle", "part_models", "linuxcnc")


def entries() -> list[dict[str, Any]]:
    return list(tomllib.loads((TESTS / "evidence.toml").read_text())["golden"])


def matched(entry: dict[str, Any]) -> set[Path]:
    """The files of an entry, without those it excepts."""
    found = {path for pattern in entry["files"] for path in TESTS.glob(pattern) if path.is_file()}
    return found - {TESTS / each for each in entry.get("except", ())}


def golden_files() -> set[Path]:
    """All files beside the sources of tests, without those that expect nothing."""
    return {
        path
        for path in TESTS.rglob("*")
        if path.is_file()
        and path.suffix not in {".py", ".pyc", ".pyi"}
        and path.name not in ("evidence.toml", "longest.json")
        and not any(part.startswith((".", "__")) for part in path.relative_to(TESTS).parts)
    }


def test_every_golden_file_names_its_evidence_once() -> None:
    counts = Counter(path for entry in entries() for path in matched(entry))
    assert {str(path.relative_to(TESTS)) for path in golden_files() - set(counts)} == set()
    assert [str(path.relative_to(TESTS)) for path, count in counts.items() if count != 1] == []


@pytest.mark.parametrize("entry", entries(), ids=lambda entry: str(entry["files"][0]))
def test_an_entry_has_a_kind_and_a_source_and_no_pattern_in_vain(entry: dict[str, Any]) -> None:
    assert entry["evidence"] in KINDS
    assert len(entry["source"]) > 20
    assert set(entry) <= {"files", "except", "evidence", "source"}
    assert [pattern for pattern in entry["files"] if not any(TESTS.glob(pattern))] == []


def imported(tree: ast.Module) -> set[str]:
    """The modules a module imports, in full."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return names


def uses_an_oracle(names: set[str]) -> bool:
    return any(
        name.split(".")[0] in ORACLES
        or (name.startswith("tests.") and set(name.split(".")) & set(ORACLE_MODULES))
        for name in names
    )


def evidence_of(tree: ast.Module) -> list[list[str]]:
    """The arguments of every `mark.evidence(...)` of a module."""
    return [
        [str(ast.literal_eval(argument)) for argument in node.args]
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr == "evidence"
    ]


MENTIONED = re.compile("|".join(["evidence", *sorted(ORACLES), *ORACLE_MODULES]))
MODULES = sorted(TESTS.rglob("test_*.py"))


def test_modules_that_compare_with_an_oracle_say_so() -> None:
    silent = []
    for path in MODULES:
        text = path.read_text(encoding="utf-8")
        if not MENTIONED.search(text):
            continue
        tree = ast.parse(text)
        given = evidence_of(tree)
        assert all(len(each) == 2 and each[0] in KINDS and each[1] for each in given), path
        if uses_an_oracle(imported(tree)) and not any(each[0] == "oracle" for each in given):
            silent.append(str(path.relative_to(TESTS)))
    assert silent == []
