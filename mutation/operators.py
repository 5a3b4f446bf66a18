"""What may be broken at a place of the source.

Each operator looks at one node of the syntax tree and yields texts that replace the text of that
node; the rest of the file, layout and comments included, stays as it is. The operators are
those whose survivors have shown missing tests: exact boundaries (`<` for `<=`), the second of a
pair (`+` for `-`, neighbouring numbers), one clause of several, effects that are left out.
"""

import ast
from collections.abc import Callable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Mutant:
    """One place and what replaces it. `start` and `end` count characters of the whole text."""

    path: str
    line: int
    name: str  # of the function or class around it, "" at the level of the module
    start: int
    end: int
    old: str
    new: str

    def apply(self, text: str) -> str:
        """The text of the file with this place broken."""
        return text[: self.start] + self.new + text[self.end :]

    def __str__(self) -> str:
        old, new = (" ".join(part.split())[:60] for part in (self.old, self.new))
        return f"{self.path}:{self.line} {self.name or 'module'}: {old} -> {new}"


Source = Callable[[ast.expr], str]
Replacements = Iterator[tuple[ast.AST, str]]

COMPARISONS: dict[type[ast.cmpop], str] = {
    ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">", ast.Eq: "!=", ast.NotEq: "==",
    ast.Is: "is not", ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in",
}  # fmt: skip
ARITHMETIC: dict[type[ast.operator], str] = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "*", ast.Mod: "*",
    ast.Pow: "*", ast.BitAnd: "|", ast.BitOr: "&", ast.BitXor: "|", ast.LShift: ">>",
    ast.RShift: "<<",
}  # fmt: skip
EXCHANGED = {
    "min": "max",
    "max": "min",
    "any": "all",
    "all": "any",
    "floor": "ceil",
    "ceil": "floor",
}


def _compare(node: ast.Compare, text: Source) -> Replacements:
    operand = node.left
    for operator, right in zip(node.ops, node.comparators, strict=True):
        if len(node.ops) == 1:
            yield node, f"{text(operand)} {COMPARISONS[type(operator)]} {text(right)}"
        operand = right


def _binary(node: ast.BinOp, text: Source) -> Replacements:
    other = ARITHMETIC.get(type(node.op))
    joins_text = any(
        isinstance(side, ast.JoinedStr) or isinstance(getattr(side, "value", None), str)
        for side in (node.left, node.right)
    )
    if other is not None and not joins_text:
        yield node, f"({text(node.left)}) {other} ({text(node.right)})"


def _boolean(node: ast.BoolOp, text: Source) -> Replacements:
    parts = [f"({text(value)})" for value in node.values]
    word, other = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
    yield node, f" {other} ".join(parts)
    for left_out in range(len(parts)):  # one clause of several
        yield node, f" {word} ".join(parts[:left_out] + parts[left_out + 1 :])


def _unary(node: ast.UnaryOp, text: Source) -> Replacements:
    if isinstance(node.op, ast.Not | ast.USub):
        yield node, f"({text(node.operand)})"


def _constant(node: ast.Constant, text: Source) -> Replacements:
    value = node.value
    if isinstance(value, bool):
        yield node, str(not value)
    elif isinstance(value, int):
        yield node, str(value + 1)
    elif isinstance(value, float):
        yield node, repr(value * 2.0 if value else 1.0)


def _condition(node: ast.If | ast.While | ast.IfExp, text: Source) -> Replacements:
    if not isinstance(node.test, ast.Compare | ast.BoolOp | ast.UnaryOp | ast.Constant):
        yield node.test, f"(not ({text(node.test)}))"


def _call(node: ast.Call, text: Source) -> Replacements:
    name = node.func
    if isinstance(name, ast.Name) and name.id in EXCHANGED:
        yield name, EXCHANGED[name.id]


def _statement(node: ast.Expr, text: Source) -> Replacements:
    if isinstance(node.value, ast.Call):
        yield node, "pass"


def _assignment(node: ast.Assign, text: Source) -> Replacements:
    if all(isinstance(target, ast.Attribute | ast.Subscript) for target in node.targets):
        yield node, "pass"


def _augmented(node: ast.AugAssign, text: Source) -> Replacements:
    other = ARITHMETIC.get(type(node.op))
    if other is not None and not isinstance(getattr(node.value, "value", None), str):
        yield node, f"{text(node.target)} {other}= {text(node.value)}"


def _raise(node: ast.Raise, text: Source) -> Replacements:
    yield node, "pass"


def _leap(node: ast.Break | ast.Continue, text: Source) -> Replacements:
    yield node, "continue" if isinstance(node, ast.Break) else "break"


OPERATORS: dict[type[ast.AST], Callable[..., Replacements]] = {
    ast.Compare: _compare, ast.BinOp: _binary, ast.BoolOp: _boolean, ast.UnaryOp: _unary,
    ast.Constant: _constant, ast.If: _condition, ast.While: _condition, ast.IfExp: _condition,
    ast.Call: _call, ast.Expr: _statement, ast.Assign: _assignment, ast.AugAssign: _augmented,
    ast.Raise: _raise, ast.Break: _leap, ast.Continue: _leap,
}  # fmt: skip


def _skipped(node: ast.AST) -> set[ast.AST]:
    """Children that say nothing of behaviour: annotations, and texts of exceptions and logs."""
    skipped: set[ast.AST | None] = set()
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        skipped.add(node.returns)
    elif isinstance(node, ast.arg | ast.AnnAssign):
        skipped.add(node.annotation)
    elif isinstance(node, ast.Call):
        name = ast.unparse(node.func)
        if name.startswith(("_log.", "cython.", "cast", "TypeVar", "ParamSpec")):
            skipped.update(ast.iter_child_nodes(node))
    elif isinstance(node, ast.If) and ast.unparse(node.test) in (
        "TYPE_CHECKING",
        "cython.compiled",
    ):
        skipped.update(ast.iter_child_nodes(node))
    return {child for child in skipped if child is not None}


class _Finder:
    """Walks one file and collects its mutants."""

    def __init__(self, path: str, text: str) -> None:
        self._path, self._text = path, text
        lengths = [len(line) for line in text.splitlines(keepends=True)]
        self._starts = [0]
        for length in lengths:
            self._starts.append(self._starts[-1] + length)
        self._lines = text.splitlines(keepends=True)
        self.found: list[Mutant] = []

    def _at(self, line: int, column: int) -> int:
        """Character of a place; the tree counts columns in bytes of UTF-8."""
        before = self._lines[line - 1].encode()[:column].decode()
        return self._starts[line - 1] + len(before)

    def _range(self, node: ast.AST) -> tuple[int, int]:
        start = self._at(node.lineno, node.col_offset)  # type: ignore[attr-defined]
        return start, self._at(node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]

    def _source(self, node: ast.expr) -> str:
        start, end = self._range(node)
        return self._text[start:end]

    def walk(self, node: ast.AST, name: str) -> None:
        """All mutants of a node and what is below it."""
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            name = f"{name}.{node.name}" if name else node.name
        operator = OPERATORS.get(type(node))
        if operator is not None:
            for place, new in operator(node, self._source):
                start, end = self._range(place)
                line: int = place.lineno  # type: ignore[attr-defined]
                old = self._text[start:end]
                self.found.append(Mutant(self._path, line, name, start, end, old, new))
        skipped = _skipped(node)
        for child in ast.iter_child_nodes(node):
            if child not in skipped:
                self.walk(child, name)


def _compiles(text: str) -> bool:
    try:
        compile(text, "mutant", "exec")
    except (SyntaxError, ValueError):
        return False
    return True


def mutants(path: str, text: str) -> list[Mutant]:
    """All mutants of a file, in the order of its lines."""
    finder = _Finder(path, text)
    finder.walk(ast.parse(text), "")
    return [mutant for mutant in finder.found if _compiles(mutant.apply(text))]
