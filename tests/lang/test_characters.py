"""Bytes of a card as a person reads and types them."""

from openacr.lang.characters import as_typed, readable


def test_utf_8_is_read_as_such_and_anything_else_as_a_character_per_byte() -> None:
    assert readable("5 \xc2\xb5m") == "5 µm"
    assert readable("5 \xb5m") == "5 µm"
    assert readable("\x93it\x92s\x94 \x96 \xe9") == '"it\'s" - é'


def test_text_is_typed_as_one_byte_per_character_where_that_is_enough() -> None:
    assert (as_typed("5 µm"), as_typed("5 “µm”")) == (b"5 \xb5m", "5 “µm”".encode())
