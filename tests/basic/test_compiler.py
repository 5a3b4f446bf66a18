"""Structure errors: found when a program is started, reported with the line, nothing runs."""

import pytest
from tests.basic.parsing import parse_line
from tests.basic.rig import Rig

import openacr.basic.commands  # noqa: F401 - enters the commands
from openacr.basic.language.scope import Scope
from openacr.basic.vm.compiler import compile_program
from openacr.basic.vm.levels import CompileError

STORED = Scope(stored=True)


def structure_error(*lines: str) -> tuple[str, int]:
    numbered = [(10 * index, parse_line(line, STORED)) for index, line in enumerate(lines, 1)]
    with pytest.raises(CompileError) as caught:
        compile_program(numbered)
    return caught.value.text, caught.value.line


@pytest.mark.parametrize(
    ("lines", "message", "line"),
    [
        (("IF (P0)", "P0=1"), "IF without ENDIF", 10),
        (("P0=1", "ELSE", "ENDIF"), "ELSE without IF", 20),
        (("ELSEIF (P0)",), "ELSE without IF", 10),
        (("ENDIF",), "ENDIF without IF", 10),
        (("IF (P0)", "ELSE", "ELSE", "ENDIF"), "ELSE without IF", 30),
        (("IF (P0)", "ELSE", "ELSEIF (P1)", "ENDIF"), "ELSE without IF", 30),
        (("FOR P0=1 TO 2", "P1=1"), "FOR without NEXT", 10),
        (("NEXT",), "NEXT without FOR", 10),
        (("WHILE (P0)",), "WHILE without WEND", 10),
        (("WEND",), "WEND without WHILE", 10),
        (("BREAK",), "BREAK without loop", 10),
        (("IF (P0)", "BREAK", "ENDIF"), "BREAK without loop", 20),
        (("_a", "P0=1", "_a"), "Duplicate label: a", 30),
        (("WHILE (P0)", "NEXT"), "NEXT without FOR", 20),
        (("FOR P0=1 TO 2", "IF (P1)", "NEXT", "ENDIF"), "IF without ENDIF", 20),
        (("IF (P1)", "FOR P0=1 TO 2", "ENDIF", "NEXT"), "FOR without NEXT", 20),
        (("FOR P0=1 TO 2", "WHILE (P1)", "NEXT"), "WHILE without WEND", 20),
    ],
)
def test_what_does_not_fit_together_is_named(
    lines: tuple[str, ...], message: str, line: int
) -> None:
    assert structure_error(*lines) == (message, line)


def test_a_structure_error_stops_the_program_before_its_first_line() -> None:
    rig = Rig()
    assert rig.run('PRINT "start"', "NEXT") == "Error in PROG0 line 30: NEXT without FOR|"
    assert not rig.is_running()
    assert not rig.bit(1024)


def test_a_deep_expression_is_computed() -> None:
    deep = "P0=" + "1+(" * 60 + "1" + ")" * 60
    assert Rig().type(deep, "?P0") == "61|"
