import pickle

import pytest
from tests.plc.rack import read

from openacr.errors import CardError
from openacr.plc.instructions import BY_WORDS, INSTRUCTIONS
from openacr.plc.reader import PlcError, PlcLine


def line(text: str) -> PlcLine:
    found = read(text)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("text", "name", "number", "spelled"),
    [
        ("LD 769", "LD", 769, "LD 769"),
        ("ld769", "LD", 769, "LD 769"),
        ("LD BIT769", "LD", 769, "LD BIT 769"),
        ("LD BIT(769)", "LD", 769, "LD BIT 769"),
        ("LD 8191", "LD", 8191, "LD 8191"),
        ("LD NOT 1", "LD NOT", 1, "LD NOT 1"),
        ("LDN 1", "LD NOT", 1, "LD NOT 1"),
        ("ANDN 1", "AND NOT", 1, "AND NOT 1"),
        ("ORN 1", "OR NOT", 1, "OR NOT 1"),
        ("ANDB", "AND LD", 0, "AND LD"),
        ("ORB", "OR LD", 0, "OR LD"),
        ("NOT", "NOT", 0, "NOT"),
        ("OUT NOT 32", "OUT NOT", 32, "OUT NOT 32"),
        ("SET32", "SET", 32, "SET 32"),
        ("CLR Lamp", "CLR", 33, "CLR Lamp"),
        ("LD TIM0", "LD", 1552, "LD TIM0"),
        ("AND CNT 1", "AND", 1588, "AND CNT1"),
        ("OR NOT KR2", "OR NOT", 1628, "OR NOT KR2"),
        ("KR 7", "KR", 7, "KR 7"),
        ("END", "END", 0, "END"),
    ],
)
def test_an_instruction_is_read_and_spelled(
    text: str, name: str, number: int, spelled: str
) -> None:
    (step,) = line(text).steps
    assert (step.instruction.name, step.number) == (name, number)
    assert line(text).spelled == spelled
    assert line(spelled) == line(text)


@pytest.mark.parametrize(
    ("text", "number", "preload"),
    [("TIM 0 500", 0, 500), ("TIM3", 3, None), ("CNT 1 10", 1, 10), ("TIM 0 : OUT 5", 0, None)],
)
def test_timers_and_counters_take_a_preload(text: str, number: int, preload: int | None) -> None:
    step = line(text).steps[0]
    assert (step.number, step.preload) == (number, preload)


def test_several_instructions_stand_apart_by_blanks_or_colons() -> None:
    found = line("ld 0 and not 1:or ld  NOT : out 32 rem lamp")
    assert [step.instruction.name for step in found.steps] == [
        "LD", "AND NOT", "OR LD", "NOT", "OUT",
    ]  # fmt: skip
    assert found.spelled == "LD 0 AND NOT 1 : OR LD NOT : OUT 32 REM lamp"
    assert found.count == 5


def test_remarks_and_frames_cost_nothing() -> None:
    assert line("REM all about it").count == 0
    assert line("REM all about it").spelled == "REM all about it"
    assert line("PROGRAM").count == line("ENDP").count == 0
    assert line("PBOOT").count == line("END").count == 1
    assert read("") is None
    assert read("' only a comment") is None


@pytest.mark.parametrize(
    ("text", "message", "column"),
    [
        ("LD 8192", "Invalid bit", 4),
        ("LD BIT 11520", "Invalid bit", 4),
        ("OUT Far", "Invalid bit", 5),
        ("LD 1.5", "Invalid bit", 4),
        ("LD Bulb", "Undefined symbol", 4),
        ("LD", "Syntax error", 3),
        ("LD -5", "Syntax error", 4),
        ("LD BIT(5", "Syntax error", 9),
        ("OR LD 5", "Syntax error", 7),
        ("5 LD", "Syntax error", 1),
        ("TIM 8", "Invalid argument", 5),
        ("LD KR8", "Invalid argument", 6),
        ("TIM 0 1.5", "Invalid argument", 7),
        ("KR 0 5", "Syntax error", 6),
        ("JMP 5", "Unknown command", 1),
        ("LD 0 ACC 5", "Not valid at this level", 6),
    ],
)
def test_what_cannot_be_read_is_refused_at_its_place(text: str, message: str, column: int) -> None:
    with pytest.raises(PlcError) as caught:
        read(text)
    assert caught.value.text == message
    assert caught.value.span.column == column
    assert isinstance(caught.value, CardError)


def test_every_instruction_has_one_name_and_survives_pickling() -> None:
    names = [words for row in INSTRUCTIONS for words in (row.words, *((s,) for s in row.synonyms))]
    assert len(names) == len(set(names)) == len(BY_WORDS)
    kept = line("LD 0 TIM 0 500")
    assert pickle.loads(pickle.dumps(kept)) == kept
