"""Arcs whose radii differ: accepted, doubted or refused, with the reading that fits."""

import math

import pytest
from tests.cnc.programs import run

from openacr.cnc.reading.findings import Finding

DEFAULT_UNIT, SPIRALS = 250_001, 250_131
NO_FIT = "the end is not on the circle about this centre"
FROM_START = (
    "I, J, K counted from the start of the arc fit: G200 F1, P250003 = 1 or --dialect rs274ngc"
)


def found(
    text: str, cells: dict[int, float] | None = None, dialect: str = "acromill"
) -> list[tuple[str, str, str]]:
    """Code, text and hint of all that was found about a program."""
    done = run(text.replace("|", "\n"), cells, dialect=dialect)
    findings: list[Finding] = [*done.interpreter.warnings]
    if done.error is not None:
        findings.append(done.error)
    return [(each.code, each.text, each.hint) for each in findings]


def arc(start_radius: float, end_radius: float, *, cells: dict[int, float] | None = None,
        dialect: str = "acromill") -> list[str]:  # fmt: skip
    """Codes of half a turn about the origin, to the left of it."""
    text = f"G0 X{start_radius:.9f}\nF10 G3 X{-end_radius:.9f} I{{}} J0"
    text = text.format(f"{-start_radius:.9f}" if dialect == "rs274ngc" else "0")
    return [code for code, _, _ in found(text, cells, dialect)]


# Equal: .0005 inch, or 0.1 % of the larger radius.
@pytest.mark.parametrize(
    ("radii", "codes"),
    [
        ((0.1, 0.1004), []),
        ((0.1004, 0.1), []),
        ((0.1, 0.1006), ["W230"]),
        ((10.0, 10.01), []),
        ((10.01, 10.0), []),
        ((9.9901, 10.0), []),
        ((10.0, 9.9901), []),
        ((10.0, 9.9899), ["W230"]),
        ((9.9899, 10.0), ["W230"]),
        ((0.75001, 1.0), ["W230"]),
        ((1.0, 0.75001), ["W230"]),
        ((0.74999, 1.0), ["E230"]),
        ((1.0, 0.74999), ["E230"]),
    ],
)
def test_how_far_radii_may_differ(radii: tuple[float, float], codes: list[str]) -> None:
    assert arc(*radii) == codes
    allowed = arc(*radii, cells={SPIRALS: 1})
    assert allowed == []
    strict = arc(*radii, dialect="rs274ngc")
    assert strict == (["E230"] if codes else [])


def test_the_absolute_tolerance_is_a_length_also_on_a_metric_machine() -> None:
    metric = {DEFAULT_UNIT: 1.0, 850_030: 21.0}
    assert arc(2.0, 2.0126, cells=metric) == []  # .0127 mm
    assert arc(2.0, 2.0128, cells=metric) == ["W230"]


def test_a_spiral_is_cut_and_mentioned_once_a_line() -> None:
    text = "F10 G2 X2 Y0 I.9 J0"
    assert found(text) == [("W230", "arc radii differ: 0.9 and 1.1", NO_FIT)]
    assert run(text).moves == ["A X2 about 0.9,0 -180"]
    assert found(text, {SPIRALS: 1}) == []


def test_radii_are_shown_in_the_unit_of_the_program() -> None:
    ((_, text, _),) = found("G21 F10 G2 X2 Y0 I.9 J0")
    assert text == "arc radii differ: 0.9 and 1.1"


# A quarter about (9,5) from (10,5) to (9,6) in the three readings; each read as another one.
RELATIVE, POSITION, NEGATIVE = "I-1 J0", "I9 J5", "I1 J0"


@pytest.mark.parametrize(
    ("reading", "words", "hint"),
    [
        (2, RELATIVE, FROM_START),
        (0, RELATIVE, FROM_START),
        (1, POSITION, "I, J, K read as a position fit: G200 F2 or P250003 = 2"),
        (0, POSITION, "I, J, K read as a position fit: G200 F2 or P250003 = 2"),
        (1, NEGATIVE, "I, J, K counted from the centre to the start of the arc fit: "
         "G200 F0 or P250003 = 0"),
        (2, NEGATIVE, "I, J, K counted from the centre to the start of the arc fit: "
         "G200 F0 or P250003 = 0"),
    ],
)  # fmt: skip
def test_a_centre_that_is_read_differently_is_refused(reading: int, words: str, hint: str) -> None:
    text = f"G0 X10 Y5|G200 F{reading}|F10 G3 X9 Y6 {words}"
    ((code, _, detail),) = found(text)
    assert (code, detail) == ("E230", hint)
    ((code, _, detail),) = found(text, {SPIRALS: 1})
    assert (code, detail) == ("W230", hint)
    right = {RELATIVE: 1, POSITION: 2, NEGATIVE: 0}[words]
    assert found(f"G0 X10 Y5|G200 F{right}|F10 G3 X9 Y6 {words}") == []


def test_the_error_says_both_radii_and_stands_at_the_words() -> None:
    done = run("G0 X10 Y5\nF10 G3 X9 Y6 I-1 J0")
    assert done.error is not None
    radii = math.dist((10, 5), (-1, 0)), math.dist((9, 6), (-1, 0))
    assert done.error.text == f"arc radii differ too much: {radii[0]:.5g} and {radii[1]:.5g}"
    assert (done.error.line, done.error.column) == (2, 14)


@pytest.mark.parametrize(
    ("plane", "start", "words", "wrong"),
    [
        ("G18", "Z10 X5", "Z9 X6 K-1 I0", "Z9 X6 K9 I5"),
        ("G19", "Y10 Z5", "Y9 Z6 J-1 K0", "Y9 Z6 J9 K5"),
    ],
)
def test_every_plane_has_its_centre_words(plane: str, start: str, words: str, wrong: str) -> None:
    text = f"{plane} G0 {start}|F10 G3 "
    assert found(text + words, dialect="rs274ngc") == []
    ((code, _, hint),) = found(text + wrong, dialect="rs274ngc")
    assert (code, hint) == ("E230", "I, J, K read as a position fit: G90.1")
    ((code, _, hint),) = found(text + words)
    assert (code, hint) == ("E230", FROM_START)
    assert found(text + wrong) == []


def test_the_reading_of_the_dialect_is_named_only_where_it_has_a_code() -> None:
    text = "G0 X10 Y5|F10 G3 X9 Y6 I1 J0"
    ((code, _, hint),) = found(text, dialect="rs274ngc")
    assert code == "E230"
    assert hint == "I, J, K counted from the centre to the start of the arc fit"
    ((code, _, hint),) = found("G0 X10 Y5|F10 G90.1 G3 X9 Y6 I-1 J0", dialect="rs274ngc")
    assert (code, hint) == ("E230", "I, J, K counted from the start of the arc fit: G91.1")


def test_a_circle_by_its_radius_has_one_radius() -> None:
    assert found("F10 G2 X2 R1.5|G3 X0 R-1.5") == []
