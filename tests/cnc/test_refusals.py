"""What the dialects refuse says why, and the page of codes lists all of it."""

from pathlib import Path

import pytest
from tests.cnc.programs import errors, made, run

from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.reading.findings import BlockError, Finding
from openacr.cnc.reading.refusals import Refusal

PAGE = Path(__file__).parents[2] / "docs" / "part-program-codes.md"
CASES = [
    pytest.param(name, row, line, id=f"{name}: {line}")
    for name, dialect in DIALECTS.items()
    for row in dialect.grammar.refusals.rows
    for line in row.lines
]
# The codes of LinuxCNC 2.9 beside user codes, and those of Fanuc milling controls beside them.
OF_OTHERS = """
G0 G1 G2 G3 G4 G5 G5.1 G5.2 G5.3 G7 G8 G10 G17 G17.1 G18 G18.1 G19 G19.1 G20 G21 G28 G28.1 G30
G30.1 G33 G33.1 G38.2 G38.3 G38.4 G38.5 G40 G41 G41.1 G42 G42.1 G43 G43.1 G43.2 G49 G50 G51 G52
G53 G54 G55 G56 G57 G58 G59 G59.1 G59.2 G59.3 G61 G61.1 G64 G68 G69 G70 G71 G71.1 G71.2 G72 G72.1
G72.2 G73 G74 G76 G80 G81 G82 G83 G84 G85 G86 G87 G88 G89 G90 G90.1 G91 G91.1 G92 G92.1 G92.2
G92.3 G93 G94 G95 G96 G97 G98 G99 G12 G13 G15 G16 G54.1 G68.2
M0 M1 M2 M3 M4 M5 M6 M7 M8 M9 M19 M30 M48 M49 M50 M51 M52 M53 M60 M61 M62 M63 M64 M65 M66 M67 M68
M70 M71 M72 M73 M98 M99
""".split()


def finding(line: str, dialect: str) -> Finding:
    """The error of a line, at load or in the run, on a machine with all axes."""
    done = made(line, dialect=dialect, axes=8)
    found = done.interpreter.program.errors
    if found:
        return found[0]
    with pytest.raises(BlockError) as caught:
        list(done.interpreter.entries())
    return caught.value.finding


@pytest.mark.parametrize(("dialect", "row", "line"), CASES)
def test_what_is_refused_says_why(dialect: str, row: Refusal, line: str) -> None:
    found = finding(line, dialect)
    assert (found.code, found.hint) == (row.error, row.reason)


@pytest.mark.parametrize("name", DIALECTS)
def test_every_refused_code_is_tried_and_no_dialect_has_what_it_refuses(name: str) -> None:
    dialect = DIALECTS[name]
    own = {code.name for code in (*dialect.table.gcodes.values(), *dialect.table.mcodes.values())}
    for row in dialect.grammar.refusals.rows:
        assert row.lines
        assert row.codes <= set(row.lines)
        assert not row.codes & own


@pytest.mark.parametrize("name", OF_OTHERS)
def test_every_code_of_other_controls_is_there_or_is_refused_with_a_reason(name: str) -> None:
    dialect = DIALECTS["rs274ngc"]
    own = {code.name for code in (*dialect.table.gcodes.values(), *dialect.table.mcodes.values())}
    assert (name in own) != bool(dialect.grammar.refusals.of_code(name))


@pytest.mark.parametrize(
    ("name", "other", "line"),
    [("acromill", "rs274ngc", "G43.1 Z1"), ("acromill", "rs274ngc", "M98 P1"),
     ("rs274ngc", "acromill", "G65 P1"), ("rs274ngc", "acromill", "M595")],
)  # fmt: skip
def test_a_code_of_the_other_dialect_names_it(name: str, other: str, line: str) -> None:
    assert finding(line, name).hint == f"a code of the dialect {other}: --dialect {other}"


@pytest.mark.parametrize("name", DIALECTS)
def test_the_page_lists_what_a_dialect_refuses(name: str) -> None:
    text = PAGE.read_text(encoding="utf-8")
    _, _, rest = text.partition(f"### Refused by {name}\n")
    section = rest.partition("\n#")[0]
    rows = [line for line in section.splitlines() if line.startswith("| ")][1:]
    refusals = DIALECTS[name].grammar.refusals
    assert rows[:-1] == [f"| {row.shown} | {row.error} | {row.reason} |" for row in refusals.rows]
    other = next(one for one in DIALECTS if one != name)
    listed, error, reason = rows[-1].strip("| ").split(" | ")
    assert (error, reason) == ("E203, E205", f"a code of the dialect {other}: --dialect {other}")
    tables = [
        {code.name for code in (*table.gcodes.values(), *table.mcodes.values())}
        for table in (DIALECTS[name].table, DIALECTS[other].table)
    ]
    assert expanded(listed) == {
        code for code in tables[1] - tables[0] if not refusals.of_code(code)
    }


def expanded(listed: str) -> set[str]:
    """The codes of a list in which `G101 … G103` is a range."""
    words = listed.split()
    found = set(words) - {"…"}
    for at, word in enumerate(words):
        if word == "…":
            first, last = words[at - 1], words[at + 1]
            found |= {f"{first[0]}{n}" for n in range(int(first[1:]), int(last[1:]))}
    return found


def test_a_refusal_is_said_only_where_it_is_meant() -> None:
    assert DIALECTS["acromill"].grammar.refusals.of_form("X1 @5", 3) == ""  # a fault before it
    polar = DIALECTS["acromill"].grammar.refusals.of_form("X1 @5", 4)
    assert polar == "no polar coordinates; write X and Y"
    assert DIALECTS["acromill"].grammar.refusals.of_form("X1 @5", 5) == ""  # and after it
    dialect = DIALECTS["rs274ngc"].grammar.refusals
    assert dialect.of_word("P", ["G1"]) == ""
    assert dialect.of_word("P", ["G1", "G30"]).startswith("there is one second reference point")
    assert dialect.of_word("W", []) == "axes are X Y Z A B C U V"
    assert dialect.of_code("G5.4") == ""


def test_a_word_of_an_active_motion_is_refused_with_its_place() -> None:
    error = run("G1 F10 X2\nX4 P3", dialect="rs274ngc").error
    assert error is not None
    assert str(error) == "PROGRAM:2:4: E206 word has no meaning in this block: P"


def test_r_of_the_tool_table_is_a_radius() -> None:
    done = run("G10 L1 P1 Z2 R.25", dialect="rs274ngc")
    assert (done.cells.read(1001), done.cells.read(2001)) == (0.25, 2.0)


def test_turns_of_the_spindle_per_minute_are_all_there_is() -> None:
    done = run("G97 S500 M3\nG0 X1", dialect="rs274ngc")
    assert done.story == ["M3 S500", "R X1", "end"]
    assert errors("G96 S500", dialect="rs274ngc") == ["E203"]
