"""Answers read back from a card are those that set it up; the rest of its set-up is noted."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs
from tests.search import search

from openacr.configure import code_files, parse_answers
from openacr.configure.answers import (
    Answers,
    AxisAnswers,
    CanOpen,
    CardAnswers,
    Drive,
    Gains,
    Limits,
    MasterAnswers,
)
from openacr.configure.differences import differences
from openacr.configure.queries import Virtual
from openacr.configure.recovered import recovered
from openacr.configure.written import written
from openacr.controller import Controller
from openacr.errors import UserError

EXAMPLES = Path(__file__).parents[2] / "examples"
NUMBERS = st.integers(0, 999_999).map(lambda n: n / 1000.0)  # six digits, as the code writes them
SIGNED = st.integers(-99_999, 99_999).map(lambda n: n / 100.0)
FLAGS = st.booleans()


def axes(number: int) -> st.SearchStrategy[AxisAnswers]:
    soft = st.tuples(SIGNED, SIGNED).filter(lambda ends: ends[0] > ends[1])
    return st.builds(
        AxisAnswers,
        number=st.just(number),
        name=st.just("A" + chr(ord("A") + number)),
        units_per_rev=st.sampled_from((1.0, 5.0, 0.2, 7.0, 1.0 / 3.0)),
        counts_per_rev=st.integers(100, 100_000),
        encoder=st.sampled_from([None, *(n for n in range(8) if n != number)]),
        dac=st.sampled_from([None, *(n for n in range(8) if n != number)]),
        excess_error=NUMBERS.filter(bool),
        gains=st.builds(Gains, pgain=SIGNED, ilimit=st.just(2.5), dwidth=NUMBERS, fbvel=SIGNED),
        drive=st.builds(Drive, FLAGS, FLAGS, FLAGS, FLAGS, FLAGS, FLAGS),
        limits=st.builds(
            Limits,
            first_input=st.sampled_from([None, *(n for n in range(1, 20) if n != 3 * number)]),
            contacts_are_closed=FLAGS,
            is_enabled=FLAGS,
            deceleration=NUMBERS,
            soft=st.none() | soft,
        ),
    )


MASTERS = st.builds(
    MasterAnswers,
    number=st.sampled_from((0, 3, 7)),
    axes=st.permutations(["AA", "AD"]).map(tuple),
    acc=NUMBERS, dec=NUMBERS, stp=NUMBERS, vel=NUMBERS, jrk=NUMBERS,
)  # fmt: skip
CARDS = st.builds(
    CardAnswers,
    option=st.sampled_from(("", "P0 U4")),
    plcs=st.integers(0, 5),
    moves=st.integers(0, 200),
    canopen=st.builds(CanOpen, master_id=st.integers(1, 127), nodes=st.integers(0, 4)),
)
ANSWERS = st.builds(
    Answers, axis=st.tuples(axes(0), axes(3)), card=CARDS, master=st.tuples(MASTERS)
)


def typed(files: dict[str, str]) -> Virtual:
    """A card on which the files of a configuration are typed, that of the answers too."""
    card = Virtual(Controller())
    for name in sorted(files, reverse=True):  # the set-up clears programs
        if name.startswith("prog"):
            card.type([name.removesuffix(".8k").upper(), "ECHO 4"])
        card.type(files[name].splitlines())
    return card


@search(500, part=60)
@given(ANSWERS)
def test_what_was_answered_is_read_back_from_the_card(answers: Answers) -> None:
    text = written(answers)
    assert parse_answers(text) == answers
    card = typed(code_files(answers, text))
    assert recovered(card, "ACR9000") == answers
    assert list(differences(card, answers)) == []


@pytest.mark.parametrize("ppu", ["24.714286", "24.7142857", "(173/7)"])
def test_a_turn_whose_written_ratio_a_card_rounds_otherwise_is_recovered(ppu: str) -> None:
    axis = AxisAnswers(number=0, name="X", units_per_rev=7.0, counts_per_rev=173)
    answers = Answers(axis=(axis,), master=(MasterAnswers(number=0, axes=("X",)),))
    files = code_files(answers, "")
    assert "AXIS0 PPU 24.714286\n" in files["setup.8k"]
    card = typed({"setup.8k": files["setup.8k"].replace("24.714286", ppu)})
    (found,) = recovered(card, "ACR9000").axis
    assert (found.units_per_rev, found.counts_per_rev) == (7.0, 173)


@search(300, part=50)
@given(ANSWERS)
def test_without_the_kept_text_the_card_is_set_up_the_same(answers: Answers) -> None:
    card = typed({"setup.8k": code_files(answers, "")["setup.8k"]})
    found = recovered(card, "ACR9000")
    assert list(differences(card, found)) == []
    assert structs.replace(found, axis=(), card=CardAnswers()) == structs.replace(
        answers, axis=(), card=CardAnswers()
    )


@pytest.fixture
def gantry() -> Controller:
    return Controller.from_project(EXAMPLES / "gantry")


def notes(card: Controller, *lines: str) -> list[str]:
    """What is noted of the gantry after lines of set-up by hand."""
    virtual = Virtual(card)
    virtual.type(lines)
    return list(differences(virtual, recovered(virtual, "ACR9000")))


@pytest.mark.parametrize(
    ("line", "note"),
    [
        ("AXIS1 JOG VEL 2.5", "AXIS1 JOG VEL is 2.5; these answers make it 0"),
        ("AXIS2 NOTCH (0,40)", "AXIS2 NOTCH is 0,40; these answers make it 0,0"),
        ("AXIS0 EXC (0.2,-0.3)", "AXIS0 EXC is 0.2,-0.3; these answers make it 0.2,-0.2"),
        ("AXIS0 EXC 0", "AXIS0 EXC is 0,0; these answers make it 1,-1"),
        ("MASTER1 LOOK TOL 0.5", "MASTER1 LOOK TOL is 0.5; these answers make it 0"),
        ("AXIS4 ON", "on without a master: AXIS4; these answers turn them off"),
        (
            "ATTACH AXIS1 ENC1 DAC1 ENC5",
            "ATTACH AXIS1 ENC1 DAC1 ENC5; these answers make it ATTACH AXIS1 ENC1 DAC1 ENC1",
        ),
    ],
)
def test_a_setting_that_answers_cannot_hold_is_noted(
    gantry: Controller, line: str, note: str
) -> None:
    assert notes(gantry) == []
    assert notes(gantry, line) == [note]


def test_a_pair_of_flags_that_differ_is_noted_by_the_second(gantry: Controller) -> None:
    (note, *others) = notes(gantry, "CLR BIT16177")
    assert note.startswith("BIT16177 (") and note.endswith("is clear; these answers make it set")
    assert others == []


def test_a_master_at_another_program_is_noted(gantry: Controller) -> None:
    found = notes(gantry, "PROG1", "DETACH", "PROG5", "ATTACH MASTER1", 'ATTACH SLAVE0 AXIS2 "Z"')
    assert found[0].startswith('PROG5: ATTACH is ATTACH MASTER1 ATTACH SLAVE0 AXIS2 "Z"; ')


def test_the_lengths_of_a_turn_fit_usual_encoders() -> None:
    card = Virtual(Controller.from_project(EXAMPLES / "gantry"))
    turns = []
    for ppu in ("1600", "8192", "22.222222", "1333.333333", "33", "0.001"):
        card.type([f"AXIS1 PPU {ppu}"])
        axis = recovered(card, "ACR9000").axis[1]
        turns.append((axis.units_per_rev, axis.counts_per_rev))
    assert turns == [(5.0, 8000), (1.0, 8192), (360.0, 8000), (360.0, 480_000), (1.0, 33),
                     (1000.0, 1)]  # fmt: skip
    card.type(["AXIS1 PPU 0.000000003"])
    with pytest.raises(UserError, match="axis 1: 3e-09 pulses per unit are no whole counts"):
        recovered(card, "ACR9000")


def test_a_card_without_masters_has_nothing_to_recover() -> None:
    with pytest.raises(UserError, match="no program has a master with axes"):
        recovered(Virtual(Controller()), "ACR9000")


def test_an_axis_of_phases_cannot_be_described() -> None:
    card = Virtual(Controller.from_project(EXAMPLES / "brushless"))
    with pytest.raises(UserError, match=r"axis 0 \(X\) is not attached to an encoder"):
        recovered(card, "ACR9000")


def test_answers_longer_than_a_page_are_read_to_their_end() -> None:
    """A mill of `openacr new` keeps answers in more lines than a listing prints at once."""
    controller = Controller()
    text = "".join(f"{10 * n} REM {n}\r" for n in range(1, 121))
    controller.send(f"DIM PROG5(9000)\rPROG5\r{text}")
    controller.advance(seconds=1)
    listed = Virtual(controller).command("LIST", program=5)
    assert listed == [f"{10 * n} REM {n}" for n in range(1, 121)]
