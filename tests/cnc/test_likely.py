"""In which dialect a text is probably written, and by what one knows."""

import re

import pytest

from openacr.cnc.loading import likely as module
from openacr.cnc.loading.likely import likely

NGC, ACR = "rs274ngc", "acromill"


def signs(text: str, centres: int = 2) -> list[tuple[str, int, str]]:
    """Dialect, weight and text of every sign."""
    found = likely(text.split("|"), centres).signs
    return [(sign.dialect, sign.weight, str(sign)) for sign in found]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("G1 X1|o<box> call [3]", [(NGC, 10, "O-word in line 2"),
                                  (NGC, 10, "expression in brackets in line 2")]),
        ("O100 sub|o100 endsub", [(NGC, 10, "O-word in line 1")]),
        ("O1000 (title)", []),
        ("#<depth>=2", [(NGC, 10, "named parameter in line 1")]),
        ("X[1+2]", [(NGC, 10, "expression in brackets in line 1")]),
        ("IF P5<10 THEN GOTO 100", [(ACR, 10, "statement in line 1")]),
        ("N10 GOSUB 200|RET", [(ACR, 10, "statement in line 1")]),
        ("M2|$I CYCLES.TXT", [(ACR, 10, "statement in line 2")]),
        ("P200=4", [(ACR, 10, "parameter P in line 1")]),
        ("G1 X(P200*2)", [(ACR, 10, "parameter P in line 1")]),
        ("G1 X1 (hole P200)", []),
        ("(if you goto 5)|; #<a> [b]", []),
        ("G4 P2", [(NGC, 3, "dwell G4 P in line 1")]),
        ("G04 P.5", [(NGC, 3, "dwell G4 P in line 1")]),
        ("G4 F2", [(ACR, 3, "dwell G4 F in line 1")]),
        ("G41 D1 P2|G40", []),
        ("G64 P.01", [(NGC, 3, "tolerance G64 P in line 1")]),
        ("%|G0 X1|%", [(NGC, 1, "framed by % in line 1")]),
        ("G43 Z1 H5", [(NGC, 1, "length G43 H in line 1")]),
        ("G43.1 Z1", [(NGC, 3, "G43.1 in line 1")]),
        ("G1 X1|M30", [(NGC, 1, "end M30 in line 2")]),
        ("G90 G94", [(NGC, 3, "G94 in line 1")]),
        ("G17|G90.1", [(NGC, 3, "G90.1 in line 2")]),
        ("G200 F1", [(ACR, 3, "G200 in line 1")]),
        ("G65 P1000 X1", [(ACR, 3, "G65 in line 1")]),
        ("M595", [(ACR, 1, "M595 in line 1")]),
        ("G0 G17 G40 G49 G80 G90",
         [(NGC, 1, "safety line with G17, G40 and G80 in line 1")]),
        ("(Post Processor: Vectric)", [(NGC, 3, "post-processor Vectric in line 1")]),
        ("(Exported by FreeCAD)", [(NGC, 3, "post-processor Freecad in line 1")]),
        ("; Fusion 360 CAM 2.0", [(NGC, 3, "post-processor Fusion 360 in line 1")]),
        ("G0 X1 Y2 Z3|G1 X4 F10|G81 X1 Z-1 R1|G80|M3 S100|M8|M2", []),
    ],
)  # fmt: skip
def test_what_only_one_dialect_has_is_a_sign(text: str, found: list[tuple[str, int, str]]) -> None:
    assert signs(text) == found


RELATIVE = (NGC, 3, "I and J from the start of the arc in line 2")
POSITION = (ACR, 3, "I and J as positions in line 2")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("G0 X10 Y5|G3 X9 Y6 I-1 J0", [RELATIVE]),
        ("G0 X10 Y5|G2 X9 Y6 I0 J1", [RELATIVE]),
        ("G0 X10 Y5|G3 X9 Y6 I9 J5", [POSITION]),
        ("G0 X10 Y5|G91 G3 X-1 Y1 I-1 J0", [RELATIVE]),
        ("G0 X10 Y5|G3 X9 Y6 R1", []),
        ("G0 X0 Y0|G3 X2 Y0 I1 J0", []),  # both readings are one
        ("G0 X10 Y5|G3 X9 Y6 I3 J7", []),  # neither is a circle
        ("G0 X10 Y5|G3 X10 Y5 I-1 J0", []),  # a whole circle is one in any reading
        ("G0 X10 Y5|G18 G3 X9 Y6 I-1 J0", []),
        ("G0 X10|G3 X9 Y6 I-1 J0", []),  # where it begins is not known
        ("G0 X10 Y5|G3 X9 Y6 I-1 J0|G3 X9 Y8 I9 J7", []),  # they do not agree
        ("G0 X10 Y5|G3 X9 Y6 (about X1 Y1) I-1 J0", [RELATIVE]),
    ],
)
def test_arcs_say_how_i_and_j_are_read(text: str, found: list[tuple[str, int, str]]) -> None:
    assert signs(text) == found


def test_arcs_say_nothing_where_the_reading_is_chosen() -> None:
    assert signs("G0 X10 Y5|G3 X9 Y6 I-1 J0", centres=1) == []
    assert signs("G0 X10 Y5|G3 X9 Y6 I9 J5", centres=1) == []
    assert signs("G91.1|G0 X10 Y5|G3 X9 Y6 I-1 J0") == [(NGC, 3, "G91.1 in line 1")]
    assert signs("G200 F1|G0 X10 Y5|G3 X9 Y6 I-1 J0") == [(ACR, 3, "G200 in line 1")]
    at_an_expression = "G0 X10 Y5|X(5+5)|G3 X9 Y6 I-1 J0"
    assert signs(at_an_expression) == []


CIRCLE = (
    "I and J of the whole circle in line 2 are read as positions (radius 150 about X-75 Y0);"
    " rs274ngc reads distances (radius 75 about X0 Y0)"
)


@pytest.mark.parametrize(
    ("text", "circle"),
    [
        ("G0 X75 Y0|G2 X75 Y0 I-75 J0|G2 X75 Y0 I-7 J0", CIRCLE),
        ("G0 X75 Y0|G2 I-75 J0", CIRCLE),
        ("G0 X0 Y0|G2 I-75 J0", ""),  # both readings are one
        ("G0 X75 Y0|G2 X70 Y0 I-75 J0", ""),  # no whole circle
        ("G0 X75|G2 I-75 J0", ""),  # where it begins is not known
        ("G18|G0 X75 Y0|G2 I-75 J0", ""),
        ("G200 F1|G0 X75 Y0|G2 I-75 J0", ""),  # the reading is chosen
    ],
)
def test_a_whole_circle_is_round_in_two_readings(text: str, circle: str) -> None:
    assert likely(text.split("|")).circle == circle


def test_a_whole_circle_has_one_reading_where_the_store_reads_distances() -> None:
    assert likely("G0 X75 Y0|G2 X75 Y0 I-75 J0".split("|"), 1).circle == ""


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("", ACR),
        ("G0 X1", ACR),
        ("%|M30", ACR),  # 2 are not enough
        ("%|G43 H1|M30", NGC),  # 3 are
        ("G94", NGC),
        ("G94|G200 F1", ACR),  # as much for one as for the other
        ("G94|%|G200 F1", NGC),
        ("G94|G93|G4 P2|P200=4", ACR),
    ],
)
def test_the_larger_sum_decides(text: str, dialect: str) -> None:
    assert likely(text.split("|")).dialect == dialect


def test_the_strongest_reasons_are_given_in_the_order_of_the_lines() -> None:
    text = "%|(Fusion 360)|G94|G43 H1|G93|#<a>=1|M30"
    assert likely(text.split("|")).reasons == [
        "post-processor Fusion 360 in line 2",
        "G94 in line 3",
        "G93 in line 5",
        "named parameter in line 6",
    ]


@pytest.mark.parametrize(
    "line",
    ["G0 1", "G1 .1", "G2.1", "G04 P1", "G0X1G91.1", "X1 @2", "N5 G94", "F10 P1=2", "X1 G01.2"],
)
def test_no_sign_is_missed_beside_ordinary_words(
    line: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = signs(line)
    monkeypatch.setattr(module, "_ORDINARY", re.compile("(?!)"))
    assert signs(line) == found


def test_ordinary_lines_have_no_sign_of_their_own() -> None:
    texts = ["N10 G1 X1.5 Y-.5 F100", "G00Z5", "X 1 Y 2", "g3 x1 y2 i.5 j.5", "G0 X1G1Y2", ""]
    for text in texts:
        assert module._ORDINARY.fullmatch(text.upper()), text
        assert list(module._signs(text.upper())) == []
