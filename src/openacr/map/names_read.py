"""Which names of the map are read: the generator writes those alone.

What counts is what is written in this tree, imports and the attributes of imported modules:

    from openacr.map.numbers import AX_BASE            numbers.AX_BASE
    from openacr.map import numbers as at; at.AX_BASE  numbers.AX_BASE
    from openacr.map.rows import axes; axes.velocity   axes.velocity
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

TREE = Path(__file__).parents[3]
READERS = ("src", "tests", "bench", "docs")
EXAMPLE = re.compile(r"```python\n(.*?)```", re.DOTALL)


def names_read() -> set[str]:
    """`module.NAME` of all that sources, tests, measurements and pages read."""
    return {name for text in _texts() if "openacr.map" in text for name in names_in(text)}


def _texts() -> Iterator[str]:
    """Every source, and every example of a page."""
    for folder in READERS:
        for path in TREE.joinpath(folder).rglob("*.py"):
            yield path.read_text(encoding="utf-8")
        for path in TREE.joinpath(folder).rglob("*.md"):
            yield from EXAMPLE.findall(path.read_text(encoding="utf-8"))


def names_in(text: str) -> Iterator[str]:
    """`module.NAME` of all that one source reads of the map."""
    nodes = list(ast.walk(ast.parse(text)))
    modules: dict[str, str] = {}
    for node in nodes:
        if isinstance(node, ast.ImportFrom):
            if node.module == "openacr.map.numbers":
                yield from (f"numbers.{each.name}" for each in node.names)
            elif node.module in ("openacr.map", "openacr.map.rows", "openacr.map.words"):
                modules |= {each.asname or each.name: each.name for each in node.names}
    for node in nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.value.id in modules:
                yield f"{modules[node.value.id]}.{node.attr}"
