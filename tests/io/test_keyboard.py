"""Keys become bytes for the card; arrows recall earlier lines."""

import pytest

from openacr.io.keyboard import History, Keyboard

UP, DOWN, RIGHT = b"\x1b[A", b"\x1b[B", b"\x1b[C"


def test_every_ordinary_key_goes_to_the_card_unchanged() -> None:
    keys = b"?P0\x08\x7f\r\x18\x19\x1a\x1b"
    assert Keyboard().feed(keys) == keys


def test_up_types_the_line_before_and_down_takes_it_back() -> None:
    keyboard = Keyboard()
    keyboard.feed(b"ONE\rTWO\r")
    assert keyboard.feed(UP) == b"TWO"
    assert keyboard.feed(UP) == b"\b\b\bONE"
    assert keyboard.feed(UP) == b"\b\b\bONE"
    assert keyboard.feed(DOWN) == b"\b\b\bTWO"
    assert keyboard.feed(DOWN) == b"\b\b\b"


@pytest.mark.parametrize("typed", [b"ABX\x08", b"junk\x1bAB"])
def test_recalling_erases_exactly_what_stands_there(typed: bytes) -> None:
    keyboard = Keyboard(History([b"OLD"]))
    keyboard.feed(typed)
    assert keyboard.feed(UP) == b"\b\bOLD"


def test_a_recalled_line_can_be_edited_and_is_remembered() -> None:
    keyboard = Keyboard(History([b"X1"]))
    assert keyboard.feed(UP + b"0\r") == b"X10\r"
    assert keyboard.history.lines == [b"X1", b"X10"]


def test_empty_and_repeated_lines_are_remembered_once() -> None:
    keyboard = Keyboard()
    keyboard.feed(b"A\rA\r\r \rB\r")
    assert keyboard.history.lines == [b"A", b"B"]


@pytest.mark.parametrize(
    "key",
    [
        pytest.param(RIGHT, id="right"),
        pytest.param(b"\x1b[3~", id="delete"),
        pytest.param(b"\x1b[H", id="home"),
        pytest.param(b"\x1bOP", id="F1"),
        pytest.param(b"\x1b[15~", id="F5"),
        pytest.param(b"\x1b[1;5C", id="ctrl-right"),
    ],
)
def test_keys_without_a_character_send_nothing(key: bytes) -> None:
    keyboard = Keyboard(History([b"OLD"]))
    assert keyboard.feed(b"A" + key + b"B") == b"AB"
    assert keyboard.feed(UP) == b"\b\bOLD"


def test_ctrl_c_leaves_without_reaching_the_card() -> None:
    keyboard = Keyboard()
    assert keyboard.feed(b"AB\x03CD") == b"AB"
    assert keyboard.leave
