"""Words that are missing, doubled, negative, fractional or huge: a finding with its place."""

from itertools import islice

from hypothesis import given
from hypothesis import strategies as st
from tests.cnc.programs import made
from tests.search import search

from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.reading.findings import TEXTS, BlockError

CODES = (
    "G0", "G1", "G2", "G3", "G4", "G5", "G5.1", "G5.2", "G5.3", "G10", "G17", "G18", "G28", "G38.3",
    "G41.1", "G43", "G43.1", "G43.2", "G52", "G53", "G54", "G64", "G73", "G81", "G82", "G92", "G91",
    "G93", "G[#1]", "G#2", "M3", "M61", "M62", "M66", "M70", "M71", "M72", "M73", "M98", "M99",
    "M[#2]", "G(P1)", "M#1", "G51", "G68", "G200",
)  # fmt: skip
LETTERS = "XYZABDEFHIJKLPQRSTUVW@^"
VALUES = st.one_of(
    st.sampled_from(["0", "1", "2", "-1", ".5", "1.5", "-0", "99999", "999999999", "1000000000000",
                     "#1", "#<_x>", "[1/0]", "[0-5]", "[2**60]", "", "-", ".", "1.2.3", "1E5"]),
    st.integers(-12, 12).map(str),
    st.floats(-1e7, 1e7, allow_nan=False).map(lambda x: f"{x:.4f}"),
)  # fmt: skip
WORDS = st.tuples(st.sampled_from(LETTERS), VALUES).map("".join)
BLOCKS = st.builds(
    lambda codes, words: " ".join([*codes, *words]),
    st.lists(st.sampled_from(CODES), max_size=3),
    st.lists(WORDS, max_size=6),
)
FIRST = {"rs274ngc": ["F10 S100", "#1=1 #2=3"], "acromill": ["F10 S100", "P1=1", "#2=3"]}


@search(250)
@given(st.sampled_from(sorted(DIALECTS)), st.lists(BLOCKS, min_size=1, max_size=6), st.booleans())
def test_any_words_are_read_or_refused_with_their_place(
    dialect: str, blocks: list[str], is_checked: bool
) -> None:
    lines = [*FIRST[dialect], *blocks, "M2"]
    options = Options(collects_errors=is_checked, has_batches=is_checked)
    done = made("\n".join(lines), {1001: 0.1, 2001: 1.0}, axes=5, dialect=dialect, options=options)
    found = list(done.interpreter.program.errors)
    if not found:
        try:
            for _ in islice(done.interpreter.entries(), 20_000):
                pass
        except BlockError as error:
            found = [error.finding]
    for each in found:
        assert each.code in TEXTS
        assert 1 <= each.line <= len(lines)
        assert 1 <= each.column <= len(lines[each.line - 1]) + 1


@search(150)
@given(
    st.lists(st.sampled_from([
        "G5.2 X1 Y1 P1", "X2 Y2 P1", "P1", "L4", "G5.3", "G5 X1 Y1 I0 J1 P0 Q-1", "G5 X2 P0 Q1",
        "M70", "M72", "M73", "o1 call", "G10 L2 P1 R30", "G10 L2 P1 R0", "G52 X1", "G92 X0", "G54",
        "G41.1 D.1", "G40", "G1 X1", "G3 X2 Y0 I1 P2", "@1 ^30", "G91", "G90", "G18", "G17", "G21",
        "G20", "G38.3 X1", "X3", "G80", "G81 X1 Z-1 R1", "M66 P1 L3 Q1", "#5230=30", "G53 G0 X0",
        "G28", "G43.1 X1", "G93", "G94 F10", "M61 Q1", "G4 P0 X1", "o1 sub\nM73\nG91\no1 endsub",
    ]), max_size=14),
    st.booleans(),
)  # fmt: skip
def test_any_order_of_blocks_moves_or_is_refused(blocks: list[str], is_checked: bool) -> None:
    if sum("sub" in block for block in blocks) > 1:
        return
    text = "\n".join(["F10", *blocks, "M2"])
    options = Options(collects_errors=is_checked, has_batches=is_checked)
    done = made(text, axes=5, dialect="rs274ngc", options=options)
    if done.interpreter.program.errors:
        return
    try:
        for _ in islice(done.interpreter.entries(), 20_000):
            pass
    except BlockError as error:
        assert error.finding.code in TEXTS
        assert error.finding.column >= 1
