"""Bytes of a card as a person reads and types them."""

import pytest

from openacr.lang.characters import Screen, as_typed, readable


def test_utf_8_is_read_as_such_and_anything_else_as_a_character_per_byte() -> None:
    assert readable("5 \xc2\xb5m") == "5 µm"
    assert readable("5 \xb5m") == "5 µm"
    assert readable("\x93it\x92s\x94 \x96 \xe9") == '"it\'s" - é'


def test_text_is_typed_as_one_byte_per_character_where_that_is_enough() -> None:
    assert (as_typed("5 µm"), as_typed("5 “µm”")) == (b"5 \xb5m", "5 “µm”".encode())


def test_control_characters_are_shown_and_only_harmless_ones_obeyed() -> None:
    obeyed = "\a\b\t\n\r"
    assert readable(obeyed) == obeyed
    controls = "".join(map(chr, range(0x20)))
    assert readable(controls) == (
        "^@^A^B^C^D^E^F\a\b\t\n^K^L\r^N^O^P^Q^R^S^T^U^V^W^X^Y^Z^[^\\^]^^^_"
    )
    assert readable("\x7f ~") == "^? ~"
    assert readable("\x80\x9b\x9f\xa0") == "<80><9B><9F>\xa0"
    assert readable("\xc2\x9b31m \xc3\xb6") == "<9B>31m ö"  # CSI as UTF-8


def test_an_escape_sequence_is_text() -> None:
    assert readable("\x1b]0;owned\x07\x1b[31mred") == "^[]0;owned\a^[[31mred"


@pytest.mark.parametrize("size", [1, 2, 3, 100])
def test_a_screen_shows_the_same_whatever_the_pieces(size: int) -> None:
    data = b"\x1b[2J 5 \xc2\xb5m \xe2\x82\xac \xb5 \x93it\x94 \xc2\x9b1m \x9b1m\b \b\r\n"
    screen = Screen()
    shown = "".join(screen.feed(data[at : at + size]) for at in range(0, len(data), size))
    assert shown == '^[[2J 5 µm € µ "it" <9B>1m <9B>1m\b \b\r\n'
