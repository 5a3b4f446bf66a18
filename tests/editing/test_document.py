"""Texts that are edited: changes, and columns in the units of editors."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.editing.document import Document, Edit, Place, Span, units_of

PATH = Path("a.8k")
TEXTS = st.text(st.sampled_from("ab \r\n\x0c\u2028\u00e9\U0001d11e"), max_size=12)
PLACES = st.builds(Place, st.integers(-1, 6), st.integers(-1, 6))
EDITS = st.builds(Edit, st.builds(Span, PLACES, PLACES), TEXTS)


@pytest.mark.parametrize(
    ("text", "lines", "ends"),
    [
        ("", [""], [""]),
        ("a", ["a"], [""]),
        ("a\n", ["a", ""], ["\n", ""]),
        ("a\r\nb\rc\n\nd", ["a", "b", "c", "", "d"], ["\r\n", "\r", "\n", "\n", ""]),
        ("a\x0cb\u2028c\n", ["a\x0cb\u2028c", ""], ["\n", ""]),
    ],
)
def test_lines_end_as_editors_count_them(text: str, lines: list[str], ends: list[str]) -> None:
    document = Document.of(PATH, text)
    assert (document.lines, document.ends) == (lines, ends)
    assert document.text == text


@given(TEXTS, st.lists(EDITS, max_size=6))
def test_a_changed_document_is_as_if_its_text_were_new(text: str, edits: list[Edit]) -> None:
    document = Document.of(PATH, text)
    for edit in edits:
        before = document.text
        start, end = sorted(map(document.nearest, edit.span))
        offsets = [
            sum(len(line) + len(end) for line, end in zip(
                document.lines[: place.line], document.ends[: place.line], strict=True
            )) + place.column
            for place in (start, end)
        ]  # fmt: skip
        document.apply(edit)
        assert document.text == before[: offsets[0]] + edit.text + before[offsets[1] :]
        fresh = Document.of(PATH, document.text)
        assert (document.lines, document.ends) == (fresh.lines, fresh.ends)


def test_half_a_character_is_replaced_by_one_as_wide() -> None:
    document = Document.of(PATH, "a\ud800b")
    document.apply(Edit(Span(Place(0, 0), Place(0, 0)), "\udfff"))
    assert document.text == "\ufffda\ufffdb"
    assert document.data == "\ufffda\ufffdb".encode()


def test_every_change_is_another_revision() -> None:
    document = Document.of(PATH, "a")
    document.apply(Edit(Span(Place(0, 1), Place(0, 1)), "b"))
    assert (document.text, document.revision) == ("ab", 1)
    document.replace("c\n")
    assert (document.lines, document.revision) == (["c", ""], 2)


@pytest.mark.parametrize(
    ("units", "column"), [(0, 0), (1, 1), (2, 1), (3, 2), (4, 3), (9, 3), (-1, 0)]
)
def test_columns_of_16_bits_within_a_character_are_that_character(units: int, column: int) -> None:
    document = Document.of(PATH, "a\U0001d11eb\n")
    assert document.place_of(0, units, units_of) == Place(0, column)


def test_columns_count_in_the_units_of_the_client() -> None:
    document = Document.of(PATH, "\u00e9\U0001d11eb")
    assert document.place_of(0, 6, lambda text: len(text.encode())) == Place(0, 2)
    assert document.place_of(0, 2, len) == Place(0, 2)
    assert units_of("\u00e9\U0001d11eb") == 4


@pytest.mark.parametrize(
    ("place", "nearest"),
    [((-1, 5), (0, 0)), ((0, 9), (0, 2)), ((0, -1), (0, 0)), ((1, 0), (1, 0)), ((7, 0), (1, 1))],
)
def test_a_place_outside_is_the_nearest_one(place: tuple[int, int], nearest: Place) -> None:
    document = Document.of(PATH, "ab\nc")
    assert document.nearest(Place(*place)) == nearest
    assert document.whole == Span(Place(0, 0), Place(1, 1))
