"""Join the `*_cy.py` modules into one source that Cython compiles to `openacr._compiled`.

The modules are plain typed Python and also run as such. The joined form differs only in
what C needs:

- annotations become C types (float: double, int: 64-bit, F64/I32/F32/U8: pointers; with
  `checked`, bounds-checked memoryviews); literals and what is read from views of integers
  have 64 bits before anything is computed of them, as a sum of 32-bit operands would wrap;
- the views F, I and S of a state (that of the card, of an interpreter, of a chain) are passed as
  one pointer into their buffer;
- module constants (`NAME = number`, those of the generated modules of the map, and the numbers
  of the card's messages) become literals, so that the inner loop never looks a name up, and a
  place in a row of the map (`masters.hold[m]`) becomes a sum: the first place of the row and m
  times the distance to the next;
- every function becomes a C function that cannot raise; those listed in a module's
  `__all__` also get a Python entrance `py_<name>`, which takes the views themselves; where a
  module lists them in `__unlocked__`, too, other threads of Python run on meanwhile;
- those it lists in `__inlined__` become part of each of their callers: what every tick does for
  every axis keeps its registers and places from stage to stage.

Refused, because interpreted and compiled results could differ: `//`, `%`, `**` and
imports other than those of the core itself.
"""

import ast
import functools
import hashlib
import os
import re
from collections.abc import Iterator, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from runpy import run_path

from openacr import messages
from openacr.unity_c import (
    Constant,
    Inline,
    Qualified,
    UnityError,
    address_views,
    compiled_function,
    entrance,
    is_docstring,
    pass_one_pointer,
    state_places,
)

PACKAGE = Path(__file__).parent
# What the sources import of C, and where Cython finds it.
LIBRARIES = {"openacr.cmath": "libc.math", "openacr.csystem": "openacr.csystem"}
CONSTANT_MODULES = ("openacr.map.numbers",)
OWN_ROWS = "openacr.cnc.rows"  # written by hand; the others are generated: places, masks, and
# the numbers that both are made of
ROW_PACKAGES = ("openacr.map", "openacr.map.rows", "openacr.map.words", OWN_ROWS)


def source_files() -> list[Path]:
    """The compiled sources: every `*_cy.py` of the package, by name."""
    found = []
    for folder, inner, names in os.walk(PACKAGE):
        inner[:] = [name for name in inner if name != "__pycache__"]
        found += [Path(folder, name) for name in names if name.endswith("_cy.py")]
    return sorted(found)


def joining_order(files: Sequence[Path]) -> list[Path]:
    """The files so that each comes after those it imports; UnityError for a circle."""
    wanted = set(files)
    imports = {path: [each for each in _imported(path) if each in wanted] for path in files}
    try:
        return list(TopologicalSorter(imports).static_order())
    except CycleError as error:
        names = " -> ".join(path.stem for path in error.args[1])
        raise UnityError(f"compiled sources import each other: {names}") from None


def _imported(path: Path) -> Iterator[Path]:
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.endswith("_cy"):
            yield _source_of(node.module)


def _source_of(module: str) -> Path:
    return PACKAGE.parent.joinpath(*module.split(".")).with_suffix(".py")


def deciding_files() -> list[Path]:
    """The files that decide the content of the extension."""
    joining = [Path(__file__), PACKAGE / "unity_c.py", PACKAGE / "csystem.pxd"]
    places = PACKAGE / "map" / "fingerprint.py"  # of all names, those too that nothing reads
    own = sorted(_source_of(OWN_ROWS).with_suffix("").glob("*.py"))
    return [*source_files(), places, *own, *joining]


def source_hash() -> str:
    """Fingerprint of everything that decides the content of the extension."""
    digest = hashlib.blake2b(digest_size=16)
    for path in deciding_files():
        digest.update(path.read_bytes())
    digest.update(repr(_message_numbers()).encode())
    return digest.hexdigest()


def source_sizes() -> list[tuple[str, int]]:
    """Place below the package and size of each of these files, for a look that takes no time."""
    files = [*deciding_files(), Path(messages.__file__)]
    return [(os.path.relpath(path, PACKAGE), path.stat().st_size) for path in files]


def write_unity(target: Path, *, checked: bool) -> Path:
    """Write the joined source to `target`, leaving an unchanged file alone."""
    text = unity_source(checked=checked)
    target.parent.mkdir(parents=True, exist_ok=True)
    if not target.exists() or target.read_text() != text:
        target.write_text(text)
    return target


def unity_source(*, checked: bool = False) -> str:
    """The joined source text."""
    libraries: dict[str, set[str]] = {module: set() for module in LIBRARIES}
    functions: dict[str, ast.FunctionDef] = {}
    lists: dict[str, list[str]] = {"__all__": [], "__unlocked__": [], "__inlined__": []}
    for path in joining_order(source_files()):
        _collect(path, libraries, functions, lists)
    blocks = [
        "import cython",
        *(
            f"from cython.cimports.{LIBRARIES[module]} import {', '.join(sorted(names))}"
            for module, names in libraries.items()
            if names
        ),
        f"SOURCE_HASH = {source_hash()!r}",
        f"SOURCE_SIZES = {source_sizes()!r}",
        f"CHECKED = {checked!r}",
    ]
    entrances = [
        entrance(functions[name], checked=checked, unlocked=name in lists["__unlocked__"])
        for name in lists["__all__"]
    ]
    if not checked:
        places = {name: state_places(function) for name, function in functions.items()}
        for function in functions.values():
            pass_one_pointer(function, places)
    for name, function in functions.items():
        if checked:
            address_views(function, libraries["openacr.csystem"])
        inlined = name in lists["__inlined__"]
        blocks.append(ast.unparse(compiled_function(function, checked=checked, inlined=inlined)))
    blocks.extend(entrances)
    return re.sub(r"\b_wide_(\d+)\b", r"\1LL", "\n\n".join(blocks)) + "\n"


def _message_numbers() -> dict[str, Constant]:
    """`messages.NAME.number`, as the sources write it, of every message of the card."""
    rows = vars(messages).items()
    return {
        f"messages.{name}.number": row.number
        for name, row in rows
        if isinstance(row, messages.Message)
    }


@functools.cache
def _module_constants(path: Path) -> dict[str, Constant]:
    """The module-level numbers of a source file, those it imports from others included."""
    found: dict[str, Constant] = {}
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.module:
            found |= _imported_constants(node)
        _take_constant(node, found)
    return found


def _imported_constants(node: ast.ImportFrom) -> dict[str, Constant]:
    """What an import brings in: numbers by their names, rows as `module.name`."""
    module = node.module or ""
    source = PACKAGE.parent.joinpath(*module.split("."))
    if module in ROW_PACKAGES:
        return {
            f"{each.asname or each.name}.{name}": value
            for each in node.names
            for name, value in run_path(str(source / f"{each.name}.py")).items()
            if isinstance(value, int | float | tuple | range)
        }
    if module not in CONSTANT_MODULES and not module.endswith("_cy"):
        return {}
    others = _module_constants(source.with_suffix(".py"))
    return {each.name: others[each.name] for each in node.names if each.name in others}


def _take_constant(node: ast.stmt, constants: dict[str, Constant]) -> bool:
    """Record `NAME = expression of numbers and known constants`; False if it is not one."""
    if isinstance(node, ast.AnnAssign) and node.value is not None:
        target: ast.expr = node.target
        value = node.value
    elif isinstance(node, ast.Assign) and len(node.targets) == 1:
        target, value = node.targets[0], node.value
    else:
        return False
    if not isinstance(target, ast.Name) or not target.id.isupper():
        return False
    try:
        plain = ast.fix_missing_locations(ast.Expression(Qualified(constants).visit(value)))
        number = eval(compile(plain, "<constant>", "eval"), {"__builtins__": {}}, dict(constants))
    except (NameError, TypeError):
        return False
    if isinstance(number, bool) or not isinstance(number, int | float):
        return False
    constants[target.id] = number
    return True


def _collect(
    path: Path,
    libraries: dict[str, set[str]],
    functions: dict[str, ast.FunctionDef],
    lists: dict[str, list[str]],
) -> None:
    constants = dict(_module_constants(path))
    inliner = Inline(constants | _message_numbers())
    for node in ast.parse(path.read_text(), str(path)).body:
        if isinstance(node, ast.ImportFrom):
            _check_import(node, path, libraries)
        elif isinstance(node, ast.FunctionDef):
            if node.name in functions:
                raise UnityError(f"{path.name}: function {node.name} is defined twice")
            _check_operators(node, path)
            functions[node.name] = inliner.visit(node)
        elif listed := next((name for name in lists if _is_list(node, name)), ""):
            lists[listed].extend(ast.literal_eval(node.value))  # type: ignore[attr-defined]
        elif not _take_constant(node, constants) and not is_docstring(node):
            raise UnityError(
                f"{path.name}:{node.lineno}: only functions and constants are compiled"
            )


def _check_import(node: ast.ImportFrom, path: Path, libraries: dict[str, set[str]]) -> None:
    module = node.module or ""
    if module in LIBRARIES:
        libraries[module].update(alias.name for alias in node.names)
    elif module == "openacr" and [alias.name for alias in node.names] == ["messages"]:
        return
    elif module not in (*CONSTANT_MODULES, *ROW_PACKAGES, "openacr.views") and not (
        module.endswith("_cy")
    ):
        raise UnityError(f"{path.name}:{node.lineno}: import of {module} cannot be compiled")


def _check_operators(function: ast.FunctionDef, path: Path) -> None:
    for node in ast.walk(function):
        if isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(
            node.op, ast.FloorDiv | ast.Mod | ast.Pow
        ):
            raise UnityError(f"{path.name}:{node.lineno}: //, % and ** differ between builds")


def _is_list(node: ast.stmt, name: str) -> bool:
    return (
        isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Name)
        and node.targets[0].id == name
    )
