"""What C needs of a core function: types, literals, one pointer to the state, an entrance."""

import ast
import copy
from collections.abc import Collection, Mapping
from itertools import pairwise

SCALARS = {"float": "cython.double", "int": "cython.longlong", "bool": "cython.bint"}
VIEWS = {"F64": "double", "I32": "int", "F32": "float", "U8": "uchar"}
INTEGER_VIEWS = ("I32", "U8")  # elements narrower than the integers of the sources
STATE = {"F": "F64", "I": "I32", "S": "F32"}  # the three views of the one state buffer
Number = int | float
Row = tuple[int, ...] | range  # the places of a row, one for each object
Constant = Number | Row


class UnityError(Exception):
    """A compiled source uses something that cannot be compiled faithfully."""


def is_docstring(node: ast.stmt) -> bool:
    """Whether a statement is a bare constant."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


class Qualified(ast.NodeTransformer):
    """Numbers of imported modules (`axes.COUNT`) become literals."""

    def __init__(self, constants: Mapping[str, Constant]) -> None:
        self.constants = constants

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        number = self.constants.get(ast.unparse(node))
        return ast.Constant(number) if isinstance(number, int | float) else node


class Inline(ast.NodeTransformer):
    """Constants become literals, int() and float() casts; every integer has 64 bits.

    C computes with the widest of its operands, so an element of a 32-bit view plus a
    literal would wrap at 2**31 where Python goes on. What is read from a view of integers
    is widened before anything is done with it. A place in a row becomes its sum.
    """

    def __init__(self, constants: Mapping[str, Constant]) -> None:
        self.constants = constants
        self._narrow: set[str] = set()

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        self._narrow = {
            argument.arg
            for argument in node.args.args
            if isinstance(argument.annotation, ast.Name) and argument.annotation.id in INTEGER_VIEWS
        }
        self.generic_visit(node)
        return node

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        row = self._row_of(node.value)
        self.generic_visit(node)
        if row is not None:
            return _place(row, node.slice, ast.unparse(node))
        is_narrow = isinstance(node.value, ast.Name) and node.value.id in self._narrow
        if is_narrow and isinstance(node.ctx, ast.Load):
            return _cast("int", [node])
        return node

    def visit_AugAssign(self, node: ast.AugAssign) -> ast.stmt:
        if not isinstance(node.target, ast.Subscript):
            self.generic_visit(node)
            return node
        read = copy.deepcopy(node.target)
        read.ctx = ast.Load()
        value = ast.BinOp(read, node.op, node.value)
        return self.visit_Assign(ast.copy_location(ast.Assign([node.target], value), node))

    def visit_Assign(self, node: ast.Assign) -> ast.Assign:
        self.generic_visit(node)
        return node

    def visit_Name(self, node: ast.Name) -> ast.expr:
        constant = self.constants.get(node.id)
        if isinstance(node.ctx, ast.Load) and isinstance(constant, int | float):
            return _literal(constant)
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        constant = self.constants.get(ast.unparse(node))
        if isinstance(constant, int | float):
            return _literal(constant)
        if isinstance(node.value, ast.Name) and node.value.id == "messages":
            raise UnityError(f"messages.{node.attr} is not `messages.<row>.number`")
        self.generic_visit(node)
        return node

    def _row_of(self, node: ast.expr) -> Row | None:
        """The places of a row, if an expression names one."""
        row = self.constants.get(ast.unparse(node)) if isinstance(node, ast.Attribute) else None
        return row if isinstance(row, tuple | range) else None

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        return _literal(node.value) if type(node.value) is int else node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        if isinstance(node.func, ast.Name) and node.func.id in ("int", "float"):
            return _cast(node.func.id, node.args)
        return node


def _cast(kind: str, values: list[ast.expr]) -> ast.Call:
    """A C cast to the scalar that Python calls int or float."""
    cast = ast.parse("cython.cast", mode="eval").body
    return ast.Call(cast, [ast.parse(SCALARS[kind], mode="eval").body, *values], [])


def _place(row: Row, index: ast.expr, text: str) -> ast.expr:
    """The place of object `index` in a row, computed; a row may have one break."""
    if isinstance(row, range):
        return _line(row.start, row.step, index)
    steps = [after - before for before, after in pairwise(row)]
    breaks = [n for n, step in enumerate(steps, 1) if step != steps[0]]
    if not breaks:
        return _line(row[0], steps[0], index)
    second = row[breaks[0] :]
    if row != (*_run(row[0], steps[0], breaks[0]), *_run(second[0], steps[0], len(second))):
        raise UnityError(f"{text}: the places of the row lie in more than two runs")
    if not isinstance(index, ast.Name):
        raise UnityError(f"{text}: an index into a row of two runs has to be a name")
    is_low = ast.Compare(index, [ast.Lt()], [_literal(breaks[0])])
    high = _line(second[0] - steps[0] * breaks[0], steps[0], index)
    return ast.IfExp(is_low, _line(row[0], steps[0], index), high)


def _run(first: int, step: int, count: int) -> range:
    return range(first, first + step * count, step)


def _line(first: int, step: int, index: ast.expr) -> ast.expr:
    """`first + index * step` with literals of 64 bits."""
    distance = index if step == 1 else ast.BinOp(index, ast.Mult(), _literal(step))
    return ast.BinOp(_literal(first), ast.Add(), distance)


def _literal(number: Number) -> ast.expr:
    """A literal of C type; integers have the suffix that gives them 64 bits."""
    if isinstance(number, int):
        name = ast.Name(f"_wide_{abs(number)}", ast.Load())
        return name if number >= 0 else ast.UnaryOp(ast.USub(), name)
    return ast.Constant(number)


def _c_type(annotation: ast.expr | None, *, checked: bool, where: str) -> ast.expr:
    name = annotation.id if isinstance(annotation, ast.Name) else None
    if name == "M":
        text = "cython.p_char"
    elif name in SCALARS:
        text = SCALARS[name]
    elif name in VIEWS:
        text = f"cython.{VIEWS[name]}[::1]" if checked else f"cython.p_{VIEWS[name]}"
    elif isinstance(annotation, ast.Constant) and annotation.value is None:
        text = "cython.void"
    else:
        raise UnityError(f"{where}: every argument and result needs a simple type")
    return ast.parse(text, mode="eval").body


def state_places(function: ast.FunctionDef) -> list[int]:
    """Which parameters of a function are views of the state buffer."""
    return [place for place, a in enumerate(function.args.args) if a.arg in STATE]


def pass_one_pointer(function: ast.FunctionDef, places: dict[str, list[int]]) -> None:
    """Pass the state as one pointer `M` instead of up to three into the same buffer.

    The C compiler then keeps one register for what took three, and knows that all rows lie
    at fixed distances from each other.
    """
    for call in ast.walk(function):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name):
            state = places.get(call.func.id)
            if state:
                if not all(ast.unparse(call.args[place]) in STATE for place in state):
                    raise UnityError(
                        f"{function.name}: {call.func.id} has to get F, I and S as they are"
                    )
                rest = [a for place, a in enumerate(call.args) if place not in state]
                call.args = [ast.Name("M", ast.Load()), *rest]
    state = places[function.name]
    if not state:
        return
    views = [function.args.args[place].arg for place in state]
    others = [a for place, a in enumerate(function.args.args) if place not in state]
    function.args.args = [ast.arg("M", ast.Name("M")), *others]
    lines = [f"{v}: {STATE[v]} = cython.cast(cython.p_{VIEWS[STATE[v]]}, M)" for v in views]
    function.body = [*ast.parse("\n".join(lines)).body, *function.body]


def address_views(function: ast.FunctionDef, outside: Collection[str]) -> None:
    """Let functions of C get pointers where views are bounds-checked."""
    views = {
        a.arg
        for a in function.args.args
        if isinstance(a.annotation, ast.Name) and a.annotation.id in VIEWS
    }
    for call in ast.walk(function):
        if isinstance(call, ast.Call) and ast.unparse(call.func) in outside:
            call.args = [
                ast.parse(f"cython.address({a.id}[0])", mode="eval").body
                if isinstance(a, ast.Name) and a.id in views
                else a
                for a in call.args
            ]


def compiled_function(
    function: ast.FunctionDef, *, checked: bool, inlined: bool = False
) -> ast.FunctionDef:
    """The function with types of C, as one that cannot raise; `inlined`: part of its callers."""
    where = function.name
    for argument in function.args.args:
        argument.annotation = _c_type(argument.annotation, checked=checked, where=where)
    function.returns = _c_type(function.returns, checked=checked, where=where)
    for node in ast.walk(function):
        if isinstance(node, ast.AnnAssign):
            node.annotation = _c_type(node.annotation, checked=checked, where=where)
    function.body = [node for node in function.body if not is_docstring(node)] or [ast.Pass()]
    decorators = ["cython.cfunc", "cython.nogil", "cython.exceptval(check=False)"]
    decorators += ["cython.inline"] if inlined else []
    function.decorator_list = [ast.parse(text, mode="eval").body for text in decorators]
    return function


def entrance(function: ast.FunctionDef, *, checked: bool, unlocked: bool = False) -> str:
    """The Python-callable wrapper of a compiled function; `unlocked`: without Python's lock."""
    parameters, arguments, state = [], [], []
    for argument in function.args.args:
        name = argument.arg
        kind = argument.annotation.id if isinstance(argument.annotation, ast.Name) else ""
        if kind in VIEWS:
            parameters.append(f"{name}: cython.{VIEWS[kind]}[::1]")
            address = f"cython.address({name}[0])"
            if checked:
                arguments.append(name)
            elif name in STATE:
                state.append(f"cython.cast(cython.p_char, {address})")
            else:
                arguments.append(address)
        else:
            parameters.append(f"{name}: {SCALARS[kind]}")
            arguments.append(name)
    guard = "".join(
        f"    if {state[0]} != {other}:\n        raise ValueError('views of two buffers')\n"
        for other in state[1:]
    )
    call = f"{function.name}({', '.join(state[:1] + arguments)})"
    if unlocked:
        call = f"with cython.nogil:\n        {call}"
        return f"def py_{function.name}({', '.join(parameters)}):\n{guard}    {call}"
    returns = "" if ast.unparse(function.returns or ast.Constant(None)) == "None" else "return "
    return f"def py_{function.name}({', '.join(parameters)}):\n{guard}    {returns}{call}"
