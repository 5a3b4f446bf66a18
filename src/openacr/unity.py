"""Join the `*_cy.py` modules into one source that Cython compiles to `openacr._compiled`.

The modules are plain typed Python and also run as such. The joined form differs only in
what C needs:

- annotations become C types (float: double, int: 64-bit, F64/I32/F32/U8: pointers; with
  `checked`, bounds-checked memoryviews); literals and what is read from views of integers
  have 64 bits before anything is computed of them, as a sum of 32-bit operands would wrap;
- the views F, I and S of the state are passed as one pointer into their buffer;
- module constants (`NAME = number`, those of the generated modules of the map, and the numbers
  of the card's messages) become literals, so that the inner loop never looks a name up, and a
  place in a row of the map (`masters.hold[m]`) becomes a sum: the first place of the row and m
  times the distance to the next;
- every function becomes a C function that cannot raise; those listed in a module's
  `__all__` also get a Python entrance `py_<name>`, which takes the views themselves.

Refused, because interpreted and compiled results could differ: `//`, `%`, `**` and
imports other than those of the core itself.
"""

import ast
import functools
import hashlib
import re
from pathlib import Path
from runpy import run_path

from openacr import messages
from openacr.unity_c import (
    Constant,
    Inline,
    Qualified,
    UnityError,
    compiled_function,
    entrance,
    is_docstring,
    pass_one_pointer,
    state_places,
)

PACKAGE = Path(__file__).parent
ORDER = (
    "map/kinds_cy.py",
    "map/flags_cy.py",
    "kernel/words_cy.py",
    "kernel/profile_cy.py",
    "kernel/axis_cy.py",
    "kernel/feedback_cy.py",
    "kernel/modules_cy.py",
    "kernel/analog_cy.py",
    "kernel/capture_cy.py",
    "kernel/source_cy.py",
    "kernel/gear_cy.py",
    "kernel/cam_cy.py",
    "kernel/object_cy.py",
    "kernel/sample_cy.py",
    "kernel/jogplan_cy.py",
    "kernel/homing_cy.py",
    "kernel/jog_cy.py",
    "kernel/bezier_cy.py",
    "kernel/curve_cy.py",
    "kernel/tangent_cy.py",
    "kernel/corner_cy.py",
    "kernel/path_cy.py",
    "kernel/lookahead_cy.py",
    "kernel/round_law_cy.py",
    "kernel/round_pass_cy.py",
    "kernel/round_cy.py",
    "kernel/plan_cy.py",
    "kernel/seek_cy.py",
    "kernel/interrupt_cy.py",
    "kernel/hsint_cy.py",
    "kernel/curveflags_cy.py",
    "kernel/hold_cy.py",
    "kernel/timebase_cy.py",
    "kernel/timed_cy.py",
    "kernel/sync_cy.py",
    "kernel/master_cy.py",
    "kernel/offset_cy.py",
    "kernel/limits_cy.py",
    "kernel/drive_cy.py",
    "kernel/commutator_cy.py",
    "kernel/maintain_cy.py",
    "kernel/servo_cy.py",
    "kernel/clock_cy.py",
    "kernel/fast_status_cy.py",
    "kernel/slow_cy.py",
    "kernel/fast_flags_cy.py",
    "kernel/tick_cy.py",
    "basic/vm/arith_cy.py",
    "basic/vm/functions_cy.py",
    "basic/vm/opcodes_cy.py",
    "basic/vm/values_cy.py",
    "basic/vm/flow_cy.py",
    "basic/vm/waits_cy.py",
    "basic/vm/vm_cy.py",
    "basic/vm/kinematics_cy.py",
    "basic/vm/scheduler_cy.py",
    "plant/drive_cy.py",
    "plant/phases_cy.py",
    "plant/stepper_cy.py",
    "plant/exact_cy.py",
    "plant/analog_cy.py",
    "plant/wiring_cy.py",
    "plant/step_cy.py",
    "plc/scan_cy.py",
    "network/wake_cy.py",
    "cnc/compensation/curve_cy.py",
    "cnc/compensation/join_cy.py",
    "engine/trace_cy.py",
    "engine/watch_cy.py",
    "engine/loop_cy.py",
    "cnc/scan_cy.py",
)
CONSTANT_MODULES = ("openacr.map.numbers",)
ROW_PACKAGES = ("openacr.map.rows", "openacr.map.words")  # generated, as the numbers are


def source_files() -> list[Path]:
    """The compiled sources in the order in which they are joined."""
    return [PACKAGE / name for name in ORDER]


def source_hash() -> str:
    """Fingerprint of everything that decides the content of the extension."""
    digest = hashlib.blake2b(digest_size=16)
    joining = [Path(__file__), PACKAGE / "unity_c.py"]
    generated = [PACKAGE / "map" / "numbers.py"]
    for package in ("rows", "words"):
        generated += sorted((PACKAGE / "map" / package).glob("*.py"))
    for path in [*source_files(), *generated, *joining]:
        digest.update(path.read_bytes())
    digest.update(repr(_message_numbers()).encode())
    return digest.hexdigest()


def write_unity(target: Path, *, checked: bool) -> Path:
    """Write the joined source to `target`, leaving an unchanged file alone."""
    text = unity_source(checked=checked)
    target.parent.mkdir(parents=True, exist_ok=True)
    if not target.exists() or target.read_text() != text:
        target.write_text(text)
    return target


def unity_source(*, checked: bool = False) -> str:
    """The joined source text."""
    math_names: set[str] = set()
    functions: dict[str, ast.FunctionDef] = {}
    exported: list[str] = []
    for path in source_files():
        _collect(path, math_names, functions, exported)
    blocks = [
        "import cython",
        f"from cython.cimports.libc.math import {', '.join(sorted(math_names))}"
        if math_names
        else "",
        f"SOURCE_HASH = {source_hash()!r}",
        f"CHECKED = {checked!r}",
    ]
    entrances = [entrance(functions[name], checked=checked) for name in exported]
    if not checked:
        places = {name: state_places(function) for name, function in functions.items()}
        for function in functions.values():
            pass_one_pointer(function, places)
    for function in functions.values():
        blocks.append(ast.unparse(compiled_function(function, checked=checked)))
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
            if not name.startswith("_")
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
    math_names: set[str],
    functions: dict[str, ast.FunctionDef],
    exported: list[str],
) -> None:
    constants = dict(_module_constants(path))
    inliner = Inline(constants | _message_numbers())
    for node in ast.parse(path.read_text(), str(path)).body:
        if isinstance(node, ast.ImportFrom):
            _check_import(node, path, math_names)
        elif isinstance(node, ast.FunctionDef):
            if node.name in functions:
                raise UnityError(f"{path.name}: function {node.name} is defined twice")
            _check_operators(node, path)
            functions[node.name] = inliner.visit(node)
        elif _is_all(node):
            exported.extend(ast.literal_eval(node.value))  # type: ignore[attr-defined]
        elif not _take_constant(node, constants) and not is_docstring(node):
            raise UnityError(
                f"{path.name}:{node.lineno}: only functions and constants are compiled"
            )


def _check_import(node: ast.ImportFrom, path: Path, math_names: set[str]) -> None:
    module = node.module or ""
    if module == "openacr.cmath":
        math_names.update(alias.name for alias in node.names)
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


def _is_all(node: ast.stmt) -> bool:
    return (
        isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Name)
        and node.targets[0].id == "__all__"
    )
