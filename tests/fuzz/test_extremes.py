"""Every command with numbers nothing can have: refused or taken, never a crash."""

import math
from functools import cache

import pytest
from tests.fuzz.test_lines import Victim

from openacr.basic.language import grammar as forms
from openacr.basic.language import registry
from openacr.map.numbers import USER_BASE

NUMBERS = (math.inf, -math.inf, math.nan, 1e300, -1e300, 2.0**63, -(2.0**63), 2.0**31, -1.0, 1e-320)
REBOOTS = frozenset(("REBOOT", "ERASE", "BRESET", "FLASH ERASE", "FIRMWARE", "ELOAD", "FLASH"))
COMMANDS = [row.name for row in registry.commands() if row.name not in REBOOTS]


def written(form: forms.Form) -> str:
    """The argument with every number given by P0."""
    match form:
        case forms.Condition():
            return "(P0)"
        case forms.Lvalue():
            return "LV(P0)"
        case forms.Group():
            return f"({','.join(['P0'] * form.most)})"
        case forms.AxisTargets():
            return f"X{written(form.group) if form.group else 'P0'}"
        case forms.AxisList():
            return f"X {written(form.each) if form.each else ''}"
        case forms.Object():
            words = sorted(form.words)
            return f"{words[0]}(P0)" if words else sorted(form.singles)[0]
        case forms.ParameterName():
            return "P(P0)"
        case forms.Repeat():
            return written(form.each)
        case forms.Either():
            return written(form.forms[-1])
        case forms.Word():
            return sorted(form.words)[0]
        case forms.Mark():
            return form.name
        case forms.Str():
            return "CHR$(P0)"
        case forms.Num() | forms.Bit() | forms.Bits() | forms.Expression():
            return "P0"
    return OF_ITS_OWN.get(type(form).__name__, "P0")


OF_ITS_OWN = {
    "Assignment": "LV(P0) = P0",
    "Destination": "(P0)",
    "DimensionForm": "LV(P0)",
    "InputList": "LV(P0)",
    "DefinitionForm": "aa P0",
    "PassingForm": "(P0,P0)",
    "CapturedForm": "(P0,P0,P0)",
    "SegmentForm": "(P0,P0,LA0)",
    "ArrayName": "LA(P0)",
    "CaptureForm": "(P0,P0,P0)",
    "LineRange": "10",
    "Then": "THEN P0 = 1",
    "Rest": "",
    "Modules": "",
}


def lines(name: str) -> list[str]:
    """The command with its objects and arguments, optional ones included."""
    row = registry.find(name)
    words = " ".join("(P0)" if word == registry.INDEX else word for word in row.words)
    plain = " ".join("0" if word == registry.INDEX else word for word in row.words)
    arguments = " ".join(written(form) for form in row.grammar)
    first = " ".join(written(form) for form in row.grammar[:1])
    found = [f"{words} {arguments}", f"{plain} {arguments}", f"{plain} {first}", f"{words}"]
    return [*found, *apart(f"{plain} {arguments}")]


def apart(line: str) -> list[str]:
    """The line with one of its numbers alone given by P0, the others harmless."""
    parts = line.split("P0")
    places = range(1, len(parts))
    return [
        "P0".join(("1".join(parts[:place]), "1".join(parts[place:])))
        for place in (places if len(places) > 1 else ())
    ]


@cache
def victim() -> Victim:
    return Victim()


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_survives_numbers_nothing_can_have(name: str) -> None:
    card = victim()
    for number in NUMBERS:
        for line in lines(name):
            card.host.card.memory.F[USER_BASE] = number
            card.line(line.replace("LET ", ""))
            card.host.card.advance(2)
    card.line("HALT ALL")
    card.line("PROG0")


@pytest.mark.parametrize("name", sorted(registry.functions))
def test_a_function_survives_numbers_nothing_can_have(name: str) -> None:
    takes = registry.functions[name].takes
    arguments = ["P0" if letter == "n" else '"1"' for letter in takes]
    for number in NUMBERS:
        victim().host.card.memory.F[USER_BASE] = number
        for given in (arguments, arguments[:1], ["P0"], ["$V(P0)"]):
            victim().line(f"PRINT {name}({','.join(given)})")
            victim().line(f"$V0 = {name}({','.join(given)}) + $V(P0)")
