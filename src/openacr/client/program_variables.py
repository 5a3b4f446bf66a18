"""The variables of programs: read, asked for and changed at the prompt of their program."""

import re
from collections.abc import Iterable

from msgspec import Struct

from openacr.client.effects import Op
from openacr.client.requests import Level
from openacr.client.talk import Talk
from openacr.errors import UserError

MOST = 100  # variables of a kind, or elements of an array: each is a line of its own
_SCALARS = re.compile(r"DIM (LV|SV|DV|\$V)\((\d+)(?:,\d+)?\)")
_ARRAY = re.compile(r"DIM ((?:LA|SA|DA|\$A)\d+)\((\d+)(?:,\d+)?\)")
# LV0, LA0(3): whose count DIM shows, and the place in it.
LOCAL = re.compile(r"((?:LV|SV|DV|\$V)(?=\d+$)|(?:LA|SA|DA|\$A)\d+(?=\())\(?(\d+)\)?")
_FLAG = re.compile(r"BIT\s*(\d+)", re.IGNORECASE)
_VARIABLE = re.compile(
    r"(?:P|LV|SV|DV|\$V)\s*(?:\d+|\([^:]*\))|(?:LA|SA|DA|\$A)\s*\d+\s*\([^:]*\)", re.IGNORECASE
)


class Value(Struct, frozen=True):
    """A value by name; `elements` are those of an array."""

    name: str
    text: str
    elements: "tuple[Value, ...]" = ()


def answer(talk: Talk, program: int, expression: str) -> Op[str]:
    """What `?expression` shows at the prompt of a program; UserError for more than a value."""
    require_one_block(expression)
    lines = yield from talk.query(f"?{expression}", at=Level.program(program))
    if not lines:
        raise UserError(f"{expression}: the card gives no value")
    return "\n".join(lines)


def assign(talk: Talk, program: int, target: str, value: str) -> Op[None]:
    """Change a variable, parameter or flag; UserError for anything else."""
    require_one_block(value)
    if flag := _FLAG.fullmatch(target.strip()):
        is_set = float((yield from answer(talk, program, value)))
        line = f"{'SET' if is_set else 'CLR'} {flag[1]}"
    elif _VARIABLE.fullmatch(target.strip()):
        line = f"{target.strip()}={value}"
    else:
        raise UserError(f"{target}: what can be changed are variables (LV0), P12288 and BIT516")
    yield from talk.order(line, at=Level.program(program))


def require_one_block(text: str) -> None:
    """UserError for a colon outside quotes: what follows it would be carried out."""
    if ":" in re.sub(r'"[^"]*"', "", text):
        raise UserError(f"{text}: a value is one expression, without a colon")


def variables(talk: Talk, program: int) -> Op[list[Value]]:
    """The variables and arrays that a program has dimensioned; the first ones of many."""
    found = []
    for line in (yield from talk.query("DIM", at=Level.program(program))):
        if scalars := _SCALARS.fullmatch(line):
            for number in range(min(MOST, int(scalars[2]))):
                name = f"{scalars[1]}{number}"
                found.append(Value(name, (yield from _text(talk, program, name))))
        elif array := _ARRAY.fullmatch(line):
            found.append((yield from _array(talk, program, array[1], int(array[2]))))
    return found


def dimensioned(talk: Talk, program: int, names: Iterable[str]) -> Op[dict[str, str]]:
    """The values of those of some variables and elements that a program has dimensioned."""
    counts: dict[str, int] = {}  # of LV, of LA0
    for line in (yield from talk.query("DIM", at=Level.program(program))):
        if held := _SCALARS.fullmatch(line) or _ARRAY.fullmatch(line):
            counts[held[1]] = int(held[2])
    values = {}
    for name in names:
        found = LOCAL.fullmatch(name)
        if found is not None and int(found[2]) < counts.get(found[1], 0):
            values[name] = yield from _text(talk, program, name)
    return values


def _array(talk: Talk, program: int, name: str, count: int) -> Op[Value]:
    elements = []
    for place in range(min(MOST, count)):
        element = f"{name}({place})"
        elements.append(Value(element, (yield from _text(talk, program, element))))
    more = f", the first {MOST} of which are read" if count > MOST else ""
    return Value(name, f"{count} elements{more}", tuple(elements))


def _text(talk: Talk, program: int, name: str) -> Op[str]:
    text = yield from answer(talk, program, name)
    return repr(text) if name.startswith("$") else text
