"""The magic of notebooks, and the notebook of the examples, with IPython where it is installed."""

import ast
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from openacr import Controller
from openacr.client import Card, Level
from openacr.notebook import CellError, load_ipython_extension

SQUARE = Path(__file__).parents[1] / "examples" / "square"
PAGE = json.loads((SQUARE / "square.ipynb").read_text(encoding="utf-8"))
CELLS = ["".join(cell["source"]) for cell in PAGE["cells"] if cell["cell_type"] == "code"]
PROGRAM = 'PROGRAM\nPRINT "one"\nENDP\n'


class Plain:
    """As much of IPython as the extension and the notebook need."""

    def __init__(self) -> None:
        self.user_ns: dict[str, Any] = {}
        self.magics: dict[str, Callable[[str, str], None]] = {}

    def register_magic_function(
        self, func: Callable[[str, str], None], magic_kind: str, magic_name: str
    ) -> None:
        assert magic_kind == "cell"
        self.magics[magic_name] = func

    def run(self, cell: str) -> Any:
        """Execute a cell and return the value of its last expression."""
        if cell.startswith("%%"):
            head, _, body = cell.partition("\n")
            name, _, line = head.removeprefix("%%").partition(" ")
            return self.magics[name](line, body)
        lines = cell.splitlines()
        if "%load_ext openacr.notebook" in lines:
            load_ipython_extension(self)
        tree = ast.parse("\n".join(line for line in lines if not line.startswith("%")))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, "cell", "exec"), self.user_ns)
        if isinstance(last, ast.Expr):
            return eval(compile(ast.Expression(last.value), "cell", "eval"), self.user_ns)
        return None


class Interactive:
    """A shell of IPython itself."""

    def __init__(self) -> None:
        shells = pytest.importorskip("IPython.core.interactiveshell")
        self.shell = shells.InteractiveShell()
        self.user_ns = self.shell.user_ns

    def run(self, cell: str) -> Any:
        done = self.shell.run_cell(cell)
        done.raise_error()
        return done.result


@pytest.fixture
def shell() -> Plain:
    plain = Plain()
    load_ipython_extension(plain)
    return plain


@pytest.mark.parametrize("make", [Plain, Interactive])
def test_the_notebook_of_the_examples_runs(
    make: type[Plain | Interactive],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(SQUARE)
    shell = make()
    results = [shell.run(cell) for cell in CELLS]
    assert "<td>PROG0</td><td>halted</td>" in results[0]._repr_html_()
    assert "Trace: 2500 rows, 0.0" in results[2]._repr_html_()
    corner = results[3][np.searchsorted(results[3][:, 0], 2.5)]
    assert corner == pytest.approx([2.5, 3.75, 5.0], abs=0.01)
    assert [abs(position) < 0.01 for position in results[4]] == [True, True]
    assert "<td>PROG0</td><td>halted</td>" in results[-1]._repr_html_()
    assert "ACR9000 Version 1.18.06" in capsys.readouterr().out


def test_a_cell_stores_a_program_and_prints_what_the_card_answers(
    shell: Plain, capsys: pytest.CaptureFixture[str]
) -> None:
    card = shell.user_ns["mine"] = Controller.from_project(SQUARE)
    shell.run(f"%%acr mine PROG0\n{PROGRAM}? 1+2\nLIST\n")
    assert capsys.readouterr().out.split() == ["3", "PROGRAM", "PRINT", '"one"', "ENDP"]
    with Card.open(card) as other:
        assert other.upload(Level.program(0)) == PROGRAM.replace("PRINT", " PRINT")


def test_lines_are_typed_at_sys_on_the_variable_card_if_no_other_is_named(
    shell: Plain, capsys: pytest.CaptureFixture[str]
) -> None:
    card = Controller()
    with Card.open(card) as client:
        client.go(Level.program(2))
        shell.user_ns["card"] = client
        shell.run("%%acr\nHALT ALL\n? 2*3\n")
        assert client.level == Level()
    assert capsys.readouterr().out == "6\n"


def test_a_cell_can_change_the_level_itself(shell: Plain) -> None:
    card = shell.user_ns["card"] = Controller()
    shell.run("%%acr\nDIM PLC3(500)\nPLC3\nPROGRAM\nLD 32\nOUT 33\nENDP\n")
    shell.run("%%acr PLC3\nRUN\n")
    assert "<td>PLC3</td><td>running</td>" in card._repr_html_()


@pytest.mark.parametrize(
    ("line", "body", "text"),
    [
        ("", "SYS\nVEL 4\n", "cell:2: Unknown command (moves and profile settings need a program"
         " level)"),
        ("PROG0", "PROGRAM\nX1\nFOO 3\nENDP\nRUN\n", "cell:3: "),
        ("other", "VER", "other is not defined; %%acr [CARD] [PROGn | PLCn] takes a variable with a"
         " Controller or a client.Card"),
        ("number PROG0", "VER", "number is a int; %%acr [CARD] [PROGn | PLCn] takes a variable with"
         " a Controller or a client.Card"),
        ("card fast", "VER", "'card fast' is not understood; the magic is %%acr [CARD]"
         " [PROGn | PLCn]"),
    ],
)  # fmt: skip
def test_what_is_refused_is_one_sentence_without_a_traceback(
    shell: Plain, line: str, body: str, text: str
) -> None:
    shell.user_ns |= {"card": Controller.from_project(SQUARE), "number": 3}
    with pytest.raises(CellError) as refused:
        shell.magics["acr"](line, body)
    assert str(refused.value).startswith(text)
    assert refused.value._render_traceback_() == [f"error: {refused.value}"]
    assert refused.value.__cause__ is None


def test_the_extension_needs_no_ipython(shell: Plain) -> None:
    assert "acr" in shell.magics
    assert PAGE["nbformat"] == 4 and all(not c.get("outputs") for c in PAGE["cells"])
    assert "openacr.notebook" in sys.modules
