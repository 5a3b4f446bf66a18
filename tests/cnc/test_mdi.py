"""Single blocks typed by the operator."""

from pathlib import Path

import pytest
from tests.cnc.programs import CYCLES, made, shown

from openacr.cnc.canonical import Line, Pace, Sync
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.mdi import Mdi
from openacr.cnc.loading.load import Folders, load_blank
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.state.hosts import VirtualMachine
from openacr.sysvar import Store


def mdi(text: str = "M2", cells: dict[int, float] | None = None) -> Mdi:
    return Mdi(made(text, cells).interpreter)


def does(typed: Mdi, line: str) -> list[str]:
    return [shown(entry) for entry in typed.execute(line)]


def test_the_modal_state_stays_from_line_to_line() -> None:
    typed = mdi()
    does(typed, "G91 G0")
    assert does(typed, "X1") == ["R X1"]
    assert does(typed, "X1") == ["R X2"]


@pytest.mark.req("MILL-MDI-ALLCODES")
@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("T3", ["SetCell"]),
        ("P3=55555", []),
        ("M3 S100", ["M3 S100"]),
        ("G10 L2 P1 X1", ["Sync"]),
        ("G81 X1 Z-1 R-.5", ["R X1", "R X1 Z-0.5", "L X1 Z-1", "R X1"]),
        ("G65 P5 X4", ["L X4"]),
        ("GOSUB 6", ["L Y2"]),
        ("(MSG, hello)", ["say hello"]),
        ("G4 F2", ["dwell 2"]),
        ("BIT(130) = 1", ["bit 130 1"]),
    ],
)
def test_every_kind_of_line_is_taken(line: str, wanted: list[str]) -> None:
    typed = mdi("M2\nN5 G1 F10 X(#1)\nRET\nN6 Y2\nRET")
    story = does(typed, line)
    assert [s for s in story if s != "Sync"] == [w for w in wanted if w != "Sync"]


@pytest.mark.req("MILL-MDI-BUFFER")
def test_the_buffer_takes_lines_while_it_is_on() -> None:
    typed = mdi()
    does(typed, "X1 F10")
    typed.is_buffer_on = False
    does(typed, "X2")
    assert typed.text == ["X1 F10"]


@pytest.mark.req("MILL-MDI-ERR")
@pytest.mark.parametrize("line", ["G0 X1 X2", "G30 P(9) X1", "FOO", "GOTO 5", "M2 X1 Q#"])
def test_an_invalid_line_does_nothing(line: str) -> None:
    typed = mdi()
    does(typed, "G91 G1 F10")
    typed.text.clear()
    entries = []
    with pytest.raises(BlockError):
        for entry in typed.execute("G90 " + line if line.startswith("G30") else line):
            entries.append(entry)
    assert entries == []
    assert typed.text == []
    assert typed._run.modal.distance == 91


def test_programs_with_cycles_keep_their_own() -> None:
    typed = mdi("X1 F10" + CYCLES)
    assert does(typed, "G81 X1 Z-1 R0") == ["R X1", "L X1 Z-1", "R X1"]


def test_a_compensated_chain_ends_with_its_line() -> None:
    typed = mdi("M2", {1001: 0.25})
    assert does(typed, "G41 D1 G1 F10 X1") == ["L X1 Y0.25"]
    assert does(typed, "X2") == ["L X2 Y0.25"]


@pytest.mark.parametrize(
    ("macro", "line", "wanted"),
    [
        ("P200=1/P201", "X(#1)", "L X7"),  # the locals of the call are gone
        ("G41 D1 X1\nX2\nP200=1/P201", "X9", "L X9"),  # nothing waits in the compensation
        ("M583\nP200=1/P201", "X9", "L X9"),
        ("G66 P6 X3\nP200=1/P201", "X9", "L X9"),
        ("G2 X1 Y1 I5 J5\nP200=1/P201", "X9", "L X9 Y1"),
    ],
)
def test_a_line_that_fails_in_a_call_leaves_no_trace(macro: str, line: str, wanted: str) -> None:
    typed = mdi(f"M2\nN5 {macro}\nRET\nN6 Y5\nRET", {1: 7.0, 1001: 0.25})
    does(typed, "G1 F10")
    with pytest.raises(BlockError, match="E210"):
        does(typed, "G65 P5 X4")
    *syncs, entry = typed.execute(line)
    assert all(isinstance(each, Sync) for each in syncs)
    assert shown(entry) == wanted
    assert isinstance(entry, Line)
    assert entry.pace == Pace(10.0)


def test_a_cycle_that_fails_leaves_no_trace(tmp_path: Path) -> None:
    (tmp_path / "CYCLES.TXT").write_text("N81000 G0 Z(P253)\nP200=1/P201\nRET\n")
    (tmp_path / "P.NC").write_text("M2\n$I CYCLES.TXT\n")
    typed = Mdi(made(tmp_path / "P.NC").interpreter)
    with pytest.raises(BlockError, match="E210"):
        does(typed, "G81 X1 Z-1 R0")
    assert does(typed, "F10 G2 X3 Y0 Z0 I2 J0") == ["A X3 about 2,0 -180"]


def with_files(tmp_path: Path, dialect: str = "acromill") -> Mdi:
    """MDI with the M codes of these files."""
    texts = {
        "M50.TXT": "G1 X(#1*2)\nRET\n", "m501.txt": "M50 X4\nY1\nRET\n",
        "M3.TXT": "Z9\nRET\n", "M60.TXT.OLD": "Z9\nRET\n", "XM61.TXT": "Z9\nRET\n",
    }  # fmt: skip
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    store = Store()
    program = load_blank(store, dialect, Folders(customs=tmp_path), name="MDI")
    return Mdi(Interpreter(program, store, VirtualMachine(), dialect))


def test_the_m_codes_of_files_are_known(tmp_path: Path) -> None:
    typed = with_files(tmp_path)
    assert does(typed, "F50 M50 X1.5")[-1:] == ["L X3"]
    assert does(typed, "M501")[-2:] == ["L X8", "L X8 Y1"]
    assert does(typed, "M3 S100") == ["M3 S100"]  # the dialect's own


@pytest.mark.parametrize("line", ["M60", "M61"])
def test_an_m_code_without_a_file_of_its_very_name_is_unknown(tmp_path: Path, line: str) -> None:
    with pytest.raises(BlockError) as caught:
        does(with_files(tmp_path), line)
    assert caught.value.finding.code == "E205"


def test_a_folder_of_m_codes_that_is_not_there_is_none(tmp_path: Path) -> None:
    program = load_blank(Store(), folders=Folders(customs=tmp_path / "none"))
    assert program.customs == {}


@pytest.mark.parametrize("cells", [{}, {700_006: 1.0}])
def test_the_supplied_cycles_are_added_to_a_program_once(cells: dict[int, float]) -> None:
    typed = mdi("M2", cells)
    parts = typed._run.program.parts
    assert [part.is_cycles for part in parts] == [False, True]
    Mdi(typed._run)
    assert [part.is_cycles for part in parts] == [False, True]
    assert does(typed, "G81 X1 Z-1 R-.5")[-1:] == ["R X1"]


def test_what_a_typed_line_does_and_what_is_wrong_with_it_is_line_1_of_mdi() -> None:
    typed = mdi()
    (move,) = [entry for entry in typed.execute("G1 F50 X1") if isinstance(entry, Line)]
    assert (move.source.file, move.source.line, move.source.text) == ("MDI", 1, "G1 F50 X1")
    with pytest.raises(BlockError) as caught:
        does(typed, "X(1/0)")  # found when it runs
    assert (caught.value.finding.file, caught.value.finding.line) == ("MDI", 1)
