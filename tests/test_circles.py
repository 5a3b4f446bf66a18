"""Modules import each other downwards: no circle, inside a package or between them."""

from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp
import pytest


def circle(root: str, cache: Path | None = None) -> list[str]:
    """One circle of imports among the modules of a package, those for types alone included."""
    graph = grimp.build_graph(root, cache_dir=None if cache is None else str(cache))
    imports = {each: graph.find_modules_directly_imported_by(each) for each in graph.modules}
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_no_module_imports_another_one_that_imports_it(tmp_path: Path) -> None:
    assert circle("openacr", tmp_path) == []


def test_a_circle_of_imports_for_types_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "ring_of_three"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "a.py").write_text("from ring_of_three.b import B\n")
    (package / "b.py").write_text("def f() -> None:\n    import ring_of_three.c\n")
    (package / "c.py").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert circle("ring_of_three", tmp_path) == []
    (package / "c.py").write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from ring_of_three.a import A\n"
    )
    found = circle("ring_of_three", None)
    assert {each.split(".")[1] for each in found} == {"a", "b", "c"}
