"""How a command is written, derived from its row: for the reference, and for hints."""

from __future__ import annotations

import re
from collections.abc import Iterable

from openacr.basic.language import grammar as forms
from openacr.basic.language.registry import INDEX, Command, Function, Use, functions, root
from openacr.basic.language.registry import Level as At
from openacr.lang.lexer import Token, TokenKind

_TAKES = {"n": "number", "s": "string", "e": "value", "p": "number"}
_CODE = re.compile(r"`([^`]+)`")


def syntax(row: Command) -> str:
    """The words of a command and its arguments; `{}` may be left out."""
    words = " ".join("n" if word == INDEX else word for word in row.words)
    parts = [words, *(_optional(form) for form in row.grammar)]
    return re.sub(r"\b([A-Z]+) n\b", r"\1n", " ".join(part for part in parts if part))


def call(function: Function) -> str:
    """A function with its arguments; `{}` may be left out."""
    names = [_TAKES[letter] for letter in function.takes]
    optional = len(names) - function.fewest
    if function.optional_first and optional:
        names[0] = f"{{{names[0]}}}"
    elif optional:
        names[function.fewest :] = [f"{{{name}}}" for name in names[function.fewest :]]
    return f"{function.name}({', '.join(names)})" if names else function.name


def command_before(found: Iterable[Token], column: int) -> Command | None:
    """The last command that begins at or before a column."""
    known = [token for token in found if token.column <= column]
    for place in range(len(known) - 1, -1, -1):
        if row := _command_at(known[place:]):
            return row
    return None


def function_at(found: Iterable[Token], column: int) -> Function | None:
    """The function whose call begins at a column, or in whose arguments it lies."""
    open_calls: list[Function | None] = []
    last = None
    for token in found:
        if token.column > column:
            break
        named = functions.get(str(token.value)) if token.kind is TokenKind.WORD else None
        if named is not None and token.column == column:
            return named
        if token.column == column and token.value != "(":
            break
        if token.value == "(" and token.kind is TokenKind.OPERATOR:
            open_calls.append(last)
        elif token.value == ")" and token.kind is TokenKind.OPERATOR and open_calls:
            open_calls.pop()
        last = named
    return last or next((each for each in reversed(open_calls) if each), None)


def _command_at(found: list[Token]) -> Command | None:
    """The command with the longest sequence of words that begins here."""
    node, best = root, None
    for token in found:
        word = INDEX if token.kind is TokenKind.NUMBER else str(token.value)
        if token.kind not in (TokenKind.WORD, TokenKind.NUMBER) or word not in node.children:
            break
        node = node.children[word]
        best = node.command or best
    return best


def form(each: forms.Form) -> str:
    """One argument as it is written."""
    match each:
        case forms.Condition():
            return "(condition)"
        case forms.Lvalue():
            return each.name or "variable"
        case forms.Pair():
            return "value|(plus,minus)"
        case forms.Group():
            return f"({_names(each)})"
        case forms.AxisTargets():
            target = form(each.group) if each.group else "{/}target"
            return f"axis{target} ..."
        case forms.AxisList():
            return f"axis{_argument(each.each)} ..."
        case forms.Bits():
            return "bit ..."
        case forms.Bit() | forms.ParameterName():
            return f"{'{-}' if each.signed else ''}{each.name}"
        case forms.Object():
            return _object(each)
        case forms.Repeat():
            return f"{form(each.each)}{each.separator or ' '}..."
        case forms.Either():
            return "|".join(map(form, each.forms))
        case forms.Command():
            return "command"
        case forms.Expression():
            return each.name or "expression"
        case forms.Str():
            return each.name or "text"
        case forms.Num() | forms.Word() | forms.Mark() | forms.Rest():
            return each.name or "value"
    return _of_its_own(each)


def levels(row: Command) -> str:
    """Where a command may be used, in words."""
    at = [name for level, name in _LEVELS if row.levels & level]
    if row.use is Use.BOTH:
        return f"{', '.join(at)}; typed or stored"
    return f"{', '.join(at)}; {'typed' if row.use is Use.IMMEDIATE else 'stored'} only"


_LEVELS = (
    (At.SYS, "SYS"),
    (At.SYS_BY_OBJECT, "SYS with an object named"),
    (At.PROG, "PROG"),
    (At.PLC, "PLC"),
)


def limits(each: forms.Form) -> str:
    """The limits of a whole number, if it has any."""
    if not isinstance(each, forms.Int) or (each.low, each.high) == (-2147483648, 2147483647):
        return ""
    return f"`{form(each)}`: {each.low} to {each.high}"


def reports(row: Command) -> bool:
    """Whether the command reports its value when the value is left out."""
    values = [each for each in row.grammar if not isinstance(each, forms.Mark | forms.Rest)]
    return bool(values) and row.emit is None and _may_be_left_out(values[-1])


def _may_be_left_out(each: forms.Form) -> bool:
    if isinstance(each, forms.AxisList):
        return each.each is not None and each.each.optional
    return each.optional and isinstance(each, forms.Num | forms.Group | forms.Word)


def _optional(each: forms.Form) -> str:
    text = form(each)
    return f"{{{text}}}" if each.optional else text


def _argument(each: forms.Form | None) -> str:
    if each is None:
        return ""
    return (
        f" {_optional(each)}" if each.optional or not isinstance(each, forms.Group) else form(each)
    )


def _names(group: forms.Group) -> str:
    names = group.name.split(",")
    needed, more = names[: group.fewest], names[group.fewest :]
    return ",".join(needed) + "".join(f"{{,{name}}}" for name in more)


def _object(each: forms.Object) -> str:
    words = [word for word in each.name.split("|") if word in each.words]
    found = [f"{word}n" for word in words] + sorted(each.singles)
    return "|".join([*found, "n"] if each.bare else found)


def _of_its_own(each: forms.Form) -> str:
    """A form that belongs to one command says how it is written in its first sentence."""
    sentence = (type(each).__doc__ or "").split("\n\n")[0]
    found = _CODE.findall(sentence)
    return " ".join(found[0].split()) if found else each.name or "..."
