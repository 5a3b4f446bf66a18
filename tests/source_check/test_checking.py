"""Controller files checked by a program: what editors and tests call."""

from pathlib import Path

import pytest

from openacr.basic.memory.memory_cost import line_bytes
from openacr.controller import Controller
from openacr.controller.loading import LoadError
from openacr.errors import SourceError, UserError
from openacr.lang.lexer import tokens
from openacr.lang.shape import shape
from openacr.project import Place, find_project
from openacr.source_check import check, check_text, listed, listing, meant, read
from openacr.source_check.hints import NO_ALIASES

EXAMPLES = Path(__file__).parents[2] / "examples"


def places(path: Path, text: str) -> list[tuple[str, int, int, str]]:
    return [
        (fault.path, fault.line, fault.column, fault.message) for fault in check_text(text, path)
    ]


@pytest.mark.parametrize(
    "folder", sorted(p.parent for p in EXAMPLES.glob("*/machine.toml")), ids=str
)
def test_an_example_has_no_errors(folder: Path) -> None:
    assert [str(fault) for fault in check(folder) if not fault.is_warning] == []


def test_a_text_is_checked_as_the_file_it_is_to_be(tmp_path: Path) -> None:
    setup = tmp_path / "setup.8k"
    setup.write_text(
        "SYS\nDIM PROG0(1000)\nDIM DEF(5)\n#DEFINE speed P3\nPROG0\nATTACH MASTER0\n"
        'ATTACH SLAVE0 AXIS0 "Q"\n'
    )
    program = tmp_path / "prog0.8k"
    good = "PROGRAM\n10 Q 5\n20 speed = 2\nENDP\n"
    assert places(program, good) == []
    wrong = places(program, good.replace("Q 5", "R 5"))
    assert [(path, line, column) for path, line, column, _ in wrong] == [(str(program), 2, 4)]
    assert not program.exists()


def test_the_level_of_a_name_without_one_is_given(tmp_path: Path) -> None:
    text = "10 GOTO 50\n"
    (tmp_path / "part.txt").write_text(text)
    found = check_text(text, tmp_path / "part.txt", (Place.PROGRAM, 3))
    assert [fault.line for fault in found] == [1]
    assert [fault.line for fault in check(tmp_path / "part.txt", (Place.PROGRAM, 3))] == [1]


def test_what_cannot_be_read_at_all_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no such file or folder"):
        check(tmp_path / "none.8k")
    (tmp_path / "empty.8k").write_text("")
    with pytest.raises(SourceError, match="the file is empty"):
        check(tmp_path / "empty.8k")


BROKEN = """\
PROGRAM
 QQ : IF (1 +
\t 2 +
    3) THEN SET 32 : XYZ 1
PRINT (1 +
2)
SET 33
ENDP
"""


def test_a_fault_in_the_rest_of_a_broken_line_is_placed_where_it_is(tmp_path: Path) -> None:
    text = BROKEN.replace(" QQ : ", " ")
    for number, column, wrong in (
        (2, 2, BROKEN),
        (2, 6, text.replace("(1 +\n\t", "(* +\n\t")),
        (3, 6, text.replace("\t 2 +", "\t 2 *;")),
        (4, 4, text.replace("    3) THEN", "   PP) THEN")),
        (4, 22, text),
    ):
        found = places(tmp_path / "prog0.8k", wrong)
        assert [(line, at) for _, line, at, _ in found][:1] == [(number, column)], wrong
        (tmp_path / "prog0.8k").write_text(wrong)
        with pytest.raises(LoadError) as refused:
            Controller.from_project(tmp_path)
        assert refused.value.line == number
    (tmp_path / "prog0.8k").unlink()
    bare = text.replace(" : XYZ 1", "").replace("2)\n", "2) + *\n")
    assert [each[1:3] for each in places(tmp_path / "prog0.8k", bare)] == [(6, 6)]


def test_unsaved_files_of_a_project_replace_those_on_the_disk_and_add_to_them(
    tmp_path: Path,
) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nDIM PROG0(1000)\nDIM DEF(5)\n")
    (tmp_path / "prog0.8k").write_text("")
    with pytest.raises(SourceError, match="the file is empty"):
        check(tmp_path)
    unsaved = {
        tmp_path / "setup.8k": b"SYS\nDIM PROG0(1000)\nDIM DEF(5)\n#DEFINE speed P8192\n",
        tmp_path / "prog0.8k": b"PROGRAM\nspeed = 2\nsped = 2\nENDP\n",
        tmp_path / "plc1.8k": b"LDD 1\n",
    }
    found = check(tmp_path, unsaved=unsaved)
    assert [(Path(each.path).name, each.line, each.column) for each in found] == [
        ("plc1.8k", 1, 1),
        ("prog0.8k", 3, 1),
    ]
    assert [meant(each.hint) for each in found] == ["", "speed"]
    alone = check(tmp_path / "prog0.8k", unsaved=unsaved)
    assert [(each.line, each.column) for each in alone] == [(3, 1)]


def test_a_folder_may_be_in_an_editor_alone(tmp_path: Path) -> None:
    folder = tmp_path / "nowhere"
    unsaved = {folder / "setup.8k": b"DIM PROG3(500)\n", folder / "prog3.8k": b"10 NOWORD\n"}
    assert [(fault.path, fault.line) for fault in check(folder, unsaved=unsaved)] == [
        (str(folder / "prog3.8k"), 1)
    ]
    with pytest.raises(UserError, match="no such file or folder"):
        check(tmp_path / "elsewhere", unsaved=unsaved)


@pytest.mark.parametrize(
    ("line", "column"),
    [
        ('PRINT "\u00e9\u20ac" : QQ', 14),  # two and three bytes before it
        ("VEL \u20135 : QQ", 10),  # a dash is one character for the card
        ('QQ : PRINT "\u00e9"', 1),
        ("PRINT 1 : QQ : REM \u00e9", 11),
    ],
)
def test_columns_count_characters_not_bytes(tmp_path: Path, line: str, column: int) -> None:
    found = check_text(f"PROG0\nATTACH MASTER0\n{line}\n", tmp_path / "a.8k")
    assert [(fault.line, fault.column) for fault in found] == [(3, column)]
    assert line[column - 1 :].startswith("QQ")
    close = check_text(f"PROG0\n{line.replace('QQ', 'SETT 1')}\n", tmp_path / "a.8k")
    assert [fault.hint for fault in close] == ["did you mean SET?"]


def test_a_text_is_checked_with_its_typographic_characters(tmp_path: Path) -> None:
    program = tmp_path / "prog0.8k"
    text = "PROGRAM\nPRINT \u201ca\u201d\nENDP\n"
    program.write_text(text, encoding="utf-8")
    assert check_text(text, program) == check(program) == []


def test_hints_that_propose_a_word_say_which() -> None:
    assert meant("did you mean GOTO?") == "GOTO"
    assert meant("did you mean loop?") == "loop"
    assert meant("labels: loop, start") == ""
    assert meant("the nearest: 10") == ""


def test_a_listing_knows_the_lines_it_is_made_of(tmp_path: Path) -> None:
    path = tmp_path / "a.8k"
    path.write_text("prog0 : vel 5\n\nprogram\nfor p0=1 to 2\nset 3\nnext\nendp\n")
    reader = read(path, find_project(path))
    found = [(line.number, text) for line, text in listed(reader)]
    assert found == [
        (1, "PROG0"),
        (1, ": VEL 5"),
        (3, "PROGRAM"),
        (4, " FOR P0 = 1 TO 2"),
        (5, "  SET 3"),
        (6, " NEXT"),
        (7, "ENDP"),
    ]
    assert list(listing(reader)) == [text for _, text in found]


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("class Press:\n    pass\n", []),
        ("raise SystemExit\nclass Press:\n    pass\n", []),  # it is not executed
        ("x = 1\nclass Press\n", [(2, 12, "expected ':'")]),
        ("class Other:\n    pass\n", [(1, 1, "there is no class Press")]),
        ("class Press:\n    return 1\n", [(2, 5, "'return' outside function")]),
        (None, [(1, 1, "cannot be read: no such file or directory")]),
    ],
)
def test_python_files_of_devices_are_checked_and_not_executed(
    tmp_path: Path, code: str | None, expected: list[tuple[int, int, str]]
) -> None:
    (tmp_path / "machine.toml").write_text('[[device]]\nkind = "press.py:Press"\n')
    (tmp_path / "setup.8k").write_text("SYS\n")
    if code is not None:
        (tmp_path / "press.py").write_text(code)
    found = check(tmp_path)
    assert [(each.line, each.column, each.message) for each in found] == expected
    assert {each.path for each in found} <= {str(tmp_path / "press.py")}


def test_devices_of_a_machine_file_with_errors_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text('[[device]]\nkind = "press.py:Press"\nrain = 1\n')
    (tmp_path / "setup.8k").write_text("SYS\n")
    assert [Path(each.path).name for each in check(tmp_path)] == ["machine.toml"]


@pytest.mark.parametrize(
    ("setup", "lines"),
    [
        ("SYS\n#DEFINE a BIT1\nPROG0\n#DEFINE b BIT2\n", [2, 4]),
        ("SYS\nDIM DEF(1)\n#DEFINE a BIT1\n#DEFINE b BIT2\n#DEFINE a BIT3\n", [4]),
        ("SYS\nDIM DEF(2)\n#DEFINE a BIT1\n#DEFINE b BIT2\n#DEFINE a\n", []),
        ("SYS\n#DEFINE a BIT1\nDIM DEF(1)\n#DEFINE b BIT1\n", [2]),
        ("SYS\nDIM DEF(1)\n#DEFINE a BIT1\nDEF CLEAR\n#DEFINE b BIT1\n", []),
        ("SYS\nDIM DEF(2)\nCLEAR\n#DEFINE a BIT1\n", [4]),
        ("SYS\nDIM DEF(1)\n#DEFINE a BIT1\nCLEAR\nDIM DEF(1)\n#DEFINE b BIT1\n", []),
        ("SYS\nDIM DEF(1)\nPROG0\n#DEFINE a BIT1\nCLEAR\n#DEFINE b BIT1\n", [6]),
        ("SYS\nP0=4\nDIM DEF(P0)\n#DEFINE a BIT1\n", []),  # a size that is computed
    ],
)
def test_an_alias_beyond_dim_def_is_refused_as_by_the_card(
    tmp_path: Path, setup: str, lines: list[int]
) -> None:
    (tmp_path / "setup.8k").write_text(setup)
    found = [each for each in check(tmp_path) if each.message != "Undefined variable"]
    assert [(each.line, each.message) for each in found] == [
        (line, "Out of define space") for line in lines
    ]
    assert {each.hint for each in found} <= {NO_ALIASES}
    if "P0=" not in setup:
        card = Controller()
        typed = [card.send(f"{line}\r") for line in setup.splitlines()]
        refused = [n for n, answer in enumerate(typed, 1) if "Out of define space" in answer]
        assert refused == lines


@pytest.mark.parametrize(
    ("setup", "refused"),
    [
        # a size that is computed leaves nothing to count with
        ("SYS\nDIM P(5)\nP0=100\nDIM PROG0(P0)\nPROG0\nDIM LV(6)\n", []),
        # CLEAR of a PLC is not that of the program with its number
        ("SYS\nDIM PROG0(100)\nDIM PLC0(100)\nPROG0\nDIM LV(6)\nPLC0\nCLEAR\nPROG0\nDIM LV(6)\n",
         [(9, "Re-dimensioned block")]),
        # neither a condition nor a move takes anything
        ("SYS\nDIM DEF(1)\nPROG0\nIF (BIT5) THEN SET 34\nSYS\n#DEFINE a BIT1\n#DEFINE b BIT1\n",
         [(7, "Out of define space")]),
        ('SYS\nDIM PROG0(100)\nPROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\nX10\nDIM LV(60)\n',
         [(7, "Out of memory")]),
        ("SYS\nDIM PROG0(100)\nPROG0\nIF (BIT5) THEN X10\nDIM LV(60)\n", [(5, "Out of memory")]),
        ("SYS\nDIM DEF(1)\n#DEFINE a BIT1\nPROG0\nIF (BIT5) THEN SAMP CLEAR\n#DEFINE b BIT1\n",
         [(6, "Out of define space")]),
        # a target with its number is that of the command, not the program at the prompt
        ("SYS\nDIM PROG0(100)\nPROG0\nDIM LV(6)\nCLEAR COM1\nDIM LV(6)\n",
         [(6, "Re-dimensioned block")]),
        ("SYS\nDIM PROG0(100)\nPROG0\nPROGRAM\nSET 34\nSET 35\nSET 36\nENDP\n"
         "SYS\nNEW PROG0\nPROG0\nDIM LV(15)\n", []),
        # what may have given memory back leaves nothing to count with
        ("SYS\nDIM P(1)\nDIM PROG0(100)\nPROG0\nPROGRAM\nSET 34\nSET 35\nSET 36\nENDP\n"
         "NEW PROG(P0)\nDIM LV(15)\n", []),
        ("SYS\nDIM P(1)\nP0=1\nDIM COM1(500000)\nCLEAR COM(P0)\nDIM PROG8(400000)\n", []),
        ("SYS\nDIM PROG0(100)\nPROG0\nDIM LV(6)\nIF (NOT BIT5) THEN CLEAR\nDIM LV(6)\n", []),
        ("SYS\nDIM DEF(1)\n#DEFINE a BIT1\nIF (NOT BIT5) THEN DEF CLEAR\n#DEFINE b BIT1\n", []),
        ("SYS\nDIM PROG0(100)\nPROG0\nPROGRAM\nSET 34\nSET 35\nSET 36\nENDP\n"
         "IF (NOT BIT5) THEN NEW\nDIM LV(15)\n", []),
    ],
)  # fmt: skip
def test_memory_is_counted_as_by_the_card(
    tmp_path: Path, setup: str, refused: list[tuple[int, str]]
) -> None:
    (tmp_path / "setup.8k").write_text(setup)
    messages = {"Out of memory", "Out of define space", "Re-dimensioned block"}
    found = [(each.line, each.message) for each in check(tmp_path) if each.message in messages]
    card = Controller()
    typed = [(n, card.send(f"{line}\r")) for n, line in enumerate(setup.splitlines(), 1)]
    by_card = [(n, text) for n, answer in typed for text in messages if text in answer]
    assert found == by_card == refused


@pytest.mark.parametrize(
    ("lines", "refused"),
    [
        (["CAM DIM X 5", "CAM DIM X", "CAM DIM X 5"], [(3, "Re-dimensioned block")]),
        (["CAM DIM X 5", "CAM DIM X", "BSC DIM X 5", "CAM DIM Y 5 AXIS2 5"], []),
        (["BSC DIM X 5", "BSC DIM AXIS3 4"], [(2, "Re-dimensioned block")]),
        (["CAM DIM X 5", "CAM CLEAR X Y", "CAM DIM X 64", "CAM CLEAR Y", "CAM DIM X 1"],
         [(5, "Re-dimensioned block")]),
        (["BSC DIM X 5", "CAM CLEAR X", "BSC DIM X 5"], [(3, "Re-dimensioned block")]),
        (["CAM DIM X 65", "CAM DIM X 5", "CAM CLEAR X", "AXIS3 CAM DIM 0"],
         [(1, "Out of memory"), (4, "Invalid argument")]),
        (["SYS", "CLEAR", "PROG0", "CAM DIM AXIS7 5", "BSC DIM AXIS7 5", "CAM DIM AXIS7 6"],
         [(6, "Re-dimensioned block")]),
        # a size or an axis that is computed leaves nothing to count with until CLEAR
        (["P0=3", "CAM DIM AXIS(P0) 5", "CAM CLEAR AXIS(P0)", "CAM DIM X 5"], []),
        (["P0=3", "CAM DIM X 5", "CAM CLEAR AXIS(P0)", "CAM DIM X 5", "CAM CLEAR X", "CAM DIM X 5",
          "CAM DIM X 5"], [(7, "Re-dimensioned block")]),
        (["CAM DIM X 5", "IF (NOT BIT5) THEN CAM CLEAR X", "CAM DIM X 5"], []),
        (["P0=0", "CAM DIM X 5", "IF (BIT5) THEN CAM CLEAR Y : BSC CLEAR X", "CAM DIM X (P0)",
          "CAM DIM Y 5"], [(4, "Re-dimensioned block")]),
    ],
)  # fmt: skip
def test_segments_of_cams_are_counted_as_by_the_card(
    tmp_path: Path, lines: list[str], refused: list[tuple[int, str]]
) -> None:
    begin = ["SYS", "DIM P(1)", "PROG0", "ATTACH MASTER0"]
    begin += ['ATTACH SLAVE0 AXIS3 "X"', 'ATTACH SLAVE1 AXIS1 "Y"']
    (tmp_path / "setup.8k").write_text("\n".join([*begin, *lines, ""]))
    found = [(each.line - len(begin), each.message) for each in check(tmp_path)]
    card = Controller()
    answers = [card.send(f"{line}\r").splitlines()[1:-1] for line in [*begin, *lines]]
    by_card = [(n, said[0]) for n, said in enumerate(answers, 1 - len(begin)) if said]
    assert [each for each in by_card if not each[1].isdigit()] == refused
    computed = [n for n, line in enumerate(lines, 1) if "(P0)" in line]
    assert found == [each for each in refused if each[0] not in computed]


def test_a_cam_whose_size_is_computed_may_have_been_refused(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text(
        "SYS\nDIM P(1)\nPROG0\nCAM DIM AXIS0 (P0)\nCAM DIM AXIS0 5\nCAM DIM AXIS0 5\n"
    )
    assert check(tmp_path) == []


def test_a_cam_of_an_axis_that_there_is_not_has_one_fault(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("PROG0\nBSC DIM AXIS16 5\nBSC DIM AXIS16 5\n")
    hints = [(each.line, each.hint) for each in check(tmp_path)]
    assert hints == [(line, "the card has axes 0 to 7") for line in (2, 3)]


@pytest.mark.parametrize("model", ["ACR8000", "ACR8020", "ACR9000"])
def test_objects_that_the_card_does_not_have_are_found_as_the_card_refuses_them(
    tmp_path: Path, model: str
) -> None:
    objects = (
        *("CMT{} MODE 1", "CMT{} ON", "DAC{} GAIN 1"),
        *("ENC{} MULT 4", "ENC{}", "ADC{}"),
    )
    lines = [text.format(n) for text in objects for n in (0, 7, 8, 15, 16, 19, 20)]
    lines += [f"ATTACH AXIS{n} ENC0 DAC0" for n in (7, 8, 15, 16)]
    lines += [f"ATTACH AXIS0 ENC{n} DAC0 ENC{n}" for n in (19, 20)]
    lines += [f"ATTACH AXIS0 ENC0 {word}" for word in ("CMT0", "CMT8", "DAC15", "DAC16")]
    lines += [f"ATTACH AXIS0 STEPPER{n} STEPPER{n}" for n in (7, 8, 16)]
    lines += [f"MASTER{n} VEL 5" for n in (7, 8, 16)] + [
        "MASTER(99) VEL 5",
        "enc (20) res 0",
        "ENC20 SRC 0",
    ]
    lines += ["PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "SRC ENC19", "SRC ENC20"]
    lines += ["GEAR SRC X ENC20", "GEAR SRC X ADC16", "GEAR SRC X CLK", "AXIS16 GEAR SRC CLK"]
    (tmp_path / "machine.toml").write_text(f'[card]\nmodel = "{model}"\n')
    (tmp_path / "setup.8k").write_text("\n".join(["SYS", *lines, ""]))
    found = [(each.line - 1, each.message) for each in check(tmp_path)]
    card = Controller(model)
    answers = [card.send(f"{line}\r").splitlines()[1:-1] for line in lines]
    refused = [(n, said[0]) for n, said in enumerate(answers, 1) if said and "nvalid" in said[0]]
    assert found == refused
    assert {lines[n - 1][:3] for n, _ in found} >= {"ENC", "DAC", "ADC", "CMT", "ATT", "MAS", "SRC"}


@pytest.mark.parametrize("line", ["ENC20 RES 0", "enc20 res 0", "SET 40 : DAC (16) GAIN 1"])
def test_objects_in_stored_programs_are_looked_at_too(tmp_path: Path, line: str) -> None:
    (tmp_path / "prog0.8k").write_text(f"PROGRAM\nENC19 RES 0\n{line}\nENDP\n")
    assert [(each.line, each.message) for each in check(tmp_path)] == [(3, "Invalid argument")]


def test_a_program_file_is_checked_that_takes_the_place_of_a_text_of_the_set_up(
    tmp_path: Path,
) -> None:
    (tmp_path / "setup.8k").write_text("PROG0\nPROGRAM\nGOTO there\nENDP\n")
    (tmp_path / "prog0.8k").write_text("PROGRAM\nDWL 1\nGOTO here\nENDP\n")
    assert [(Path(each.path).name, each.line) for each in check(tmp_path)] == [
        ("setup.8k", 3),
        ("prog0.8k", 3),
    ]


def test_an_alias_without_space_is_known_to_the_lines_after_it(tmp_path: Path) -> None:
    text = "PROG0\n#DEFINE lamp BIT34\nPROGRAM\nSET lamp\nENDP\n"
    (tmp_path / "setup.8k").write_text(text)
    assert [(each.line, each.message) for each in check(tmp_path)] == [(2, "Out of define space")]


def test_aliases_of_one_file_are_counted_where_it_has_dimensioned_them(tmp_path: Path) -> None:
    file = tmp_path / "set.8k"
    file.write_text("SYS\n#DEFINE lamp BIT34\n")
    assert check(file) == []
    file.write_text("SYS\nDIM DEF(1)\n#DEFINE lamp BIT34\n#DEFINE pump BIT35\n")
    assert [each.line for each in check(file)] == [4]


def test_a_text_entered_anew_is_checked_without_the_lost_lines_of_the_one_before(
    tmp_path: Path,
) -> None:
    """Levels are left alone where a line with their words cannot be read, and only there."""
    lost, whole = "PROGRAM\nIF (P0=\nENDP\n", "PROGRAM\nIF (P0=0)\nENDP\n"
    at = tmp_path / "prog0.8k"
    alone = [(line + 3, column, text) for _, line, column, text in places(at, whole)]
    assert len(alone) == 1
    assert [place[1:] for place in places(at, lost + whole)][1:] == alone


def test_numbered_lines_are_tied_together_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    lines = "PROG0\n20 ENDIF\n10 IF (BIT5)\n15 SET 40\n"
    assert places(tmp_path / "prog0.8k", lines) == []
    (fault,) = places(tmp_path / "prog0.8k", "PROG0\n10 ENDIF\n20 SET 40\n10 IF (BIT5)\n")
    assert fault[1] == 4


@pytest.mark.parametrize("remark", ["REM wait", "  ' wait", "rem"])
def test_a_remark_after_a_move_does_not_end_it(tmp_path: Path, remark: str) -> None:
    head = 'SYS\nDIM PROG0(9000)\nPROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\n'
    text = f"{head}PROGRAM\nX5\n{remark}\nSET 32\nENDP\n"
    assert [place[1] for place in places(tmp_path / "setup.8k", text)] == [9]


@pytest.mark.parametrize("line", ["P1=P4440", "SET 17664", "CLR 99999999999999999999"])
def test_numbers_of_nothing_are_found_in_stored_programs(tmp_path: Path, line: str) -> None:
    lines = f"PROGRAM\nP1=P123\nSET 40\n{line}\nENDP\n"
    assert [place[1] for place in places(tmp_path / "prog0.8k", lines)] == [4]


def test_numbered_text_continued_in_a_second_file_is_checked_as_one_text(tmp_path: Path) -> None:
    """What the second file completes is no fault of the first; each is placed in its own file."""
    (tmp_path / "setup.8k").write_text(
        "SYS\nDIM PROG0(400)\nPROG0\n10 GOTO there\n20 GOTO here\n30 _twice\n40 IF (BIT5)\n"
    )
    program = tmp_path / "prog0.8k"
    program.write_text("50 ENDIF\n60 _here\n70 _twice\n80 FOR LV0=1 TO 2\n")
    expected = [
        ("setup.8k", 4, "Label not found: there", "did you mean here?"),
        ("prog0.8k", 3, "Duplicate label: twice", "the first is in line 6 of setup.8k"),
        ("prog0.8k", 4, "FOR without NEXT", "still open at the end"),
        ("prog0.8k", 4, "Undefined variable", "no DIM LV was read"),
    ]
    found = [(Path(each.path).name, each.line, each.message, each.hint) for each in check(tmp_path)]
    assert found == expected
    assert [(each.path, each.line) for each in check(program)] == [
        (str(program), line) for _, line, *_ in expected[1:3]
    ]
    program.write_text("50 NEXT\n60 _here\n70 _here\n")
    hints = [(Path(each.path).name, each.line, each.hint) for each in check(tmp_path)]
    assert hints == [
        ("setup.8k", 4, "did you mean here?"),
        ("setup.8k", 7, "still open at the end"),
        ("prog0.8k", 1, "open here is the IF of line 7 of setup.8k"),
        ("prog0.8k", 3, "the first is in line 2"),
    ]
    (tmp_path / "setup.8k").write_text("SYS\nDIM PROG0(400)\nPROG0\n10 WHILE (1)\n20 IF (BIT5)\n")
    program.write_text("50 WEND\n")
    assert [(each.line, each.hint) for each in check(tmp_path)] == [
        (5, "still open at the WEND of line 1 of prog0.8k")
    ]


def test_a_warning_of_a_text_that_goes_on_in_a_second_file_is_given_once(tmp_path: Path) -> None:
    setup = (
        'SYS\nDIM PROG0(400)\nPROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\n10 LOPASS X 4000\n'
    )
    (tmp_path / "setup.8k").write_text(setup)
    (tmp_path / "prog0.8k").write_text("PERIOD 0.0002\n20 LOPASS X 3000\n")
    found = [(Path(each.path).name, each.line, each.hint) for each in check(tmp_path)]
    assert found == [
        ("setup.8k", 6, "at most 200 Hz at PERIOD 0.0005"),
        ("prog0.8k", 2, "at most 500 Hz at PERIOD 0.0002"),
    ]


def test_the_text_after_new_is_another_one(tmp_path: Path) -> None:
    new = "SYS\nDIM PROG0(60)\nPROG0\n10 _a\n20 GOTO b\n30 SET 32\n{}\n10 _c\n20 _a\n30 _b\n"
    faults = {
        "NEW": [(5, "Label not found: b")],
        "SYS\nNEW PROG0\nPROG0": [(5, "Label not found: b")],
        "SYS\nNEW ALL\nPROG0": [(5, "Label not found: b")],
        "NEW PROG1": [],
        "NEW PROG(P0)": [],
    }
    for line, expected in faults.items():
        (tmp_path / "setup.8k").write_text(new.format(line))
        assert [(each.line, each.message) for each in check(tmp_path)] == expected, line


def test_a_program_file_alone_has_the_memory_that_the_set_up_gives_it(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nDIM P(1)\n")
    (tmp_path / "prog9.8k").write_text("PROGRAM\nP0=1\nENDP\n")
    found = [(each.line, each.message, each.hint) for each in check(tmp_path / "prog9.8k")]
    assert found == [(1, "Out of memory", "PROG9 has no memory yet: DIM PROG9(100) at SYS")]


@pytest.mark.parametrize(
    ("line", "other"),
    [
        ("P0=1", "P0=123456789"),
        ("P0=0.5", "P0=0.123456789"),
        ('PRINT "a"', 'PRINT "abc"'),
        ("SET 32 REM on", "SET 32 REM the lamp is on"),
        ("_a1", "_a123"),
    ],
)
def test_lines_of_one_shape_take_what_each_of_them_takes(
    tmp_path: Path, line: str, other: str
) -> None:
    assert shape(line) == shape(other)
    lines = ["PROGRAM", line, other, line, "ENDP"]
    whole = sum(line_bytes(tokens(each)) for each in lines)
    (tmp_path / "prog9.8k").write_text("".join(f"{each}\n" for each in lines))
    for room in (whole, whole - 1):
        (tmp_path / "setup.8k").write_text(f"SYS\nDIM P(1)\nDIM PROG9({room})\n")
        found = [each.line for each in check(tmp_path) if each.message == "Out of memory"]
        assert found == ([] if room == whole else [5])


def test_a_text_with_a_lost_line_is_not_counted(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nDIM P(1)\nDIM PROG0(20)\n")
    (tmp_path / "prog0.8k").write_text("PROGRAM\nP0=\nP0=1\nENDP\n")
    assert [(each.line, each.message) for each in check(tmp_path)] == [(2, "Syntax error")]


def test_a_text_takes_memory_from_the_variables_of_later_files(tmp_path: Path) -> None:
    text = "PROGRAM\nSET 34\nSET 35\nSET 36\nENDP\n"  # 52 bytes
    (tmp_path / "setup.8k").write_text(f"SYS\nDIM PROG0(100)\nPROG0\n{text}")
    other = tmp_path / "prog1.8k"
    other.write_text("PROG0\nDIM LV(12)\n")
    assert check(tmp_path) == []
    other.write_text("PROG0\nDIM LV(13)\n")
    assert [(Path(each.path).name, each.message) for each in check(tmp_path)] == [
        ("prog1.8k", "Out of memory")
    ]


@pytest.mark.parametrize("model", ["ACR8020", "ACR9000"])
def test_streams_are_those_of_the_card(tmp_path: Path, model: str) -> None:
    (tmp_path / "machine.toml").write_text(f'[card]\nmodel = "{model}"\n')
    (tmp_path / "setup.8k").write_text("SYS\nDIM DPCB(500)\n")
    messages = [each.message for each in check(tmp_path)]
    assert messages == ([] if model == "ACR8020" else ["Invalid device"])
