"""Program text as it is kept."""

from collections.abc import Callable

import pytest

from openacr.basic.language.scope import Scope
from openacr.basic.memory.program_store import ProgramStore, StoredLine, line_number, opens_capture
from openacr.basic.memory.storage import Storage
from openacr.errors import CardError
from openacr.lang.lexer import tokens
from openacr.map.memory import Memory
from openacr.map.words import pf


@pytest.fixture
def store() -> ProgramStore:
    return ProgramStore(Storage(Memory()))


def line(number: int, text: str = "DWL 1", cost: int = 12) -> StoredLine:
    return StoredLine(number, text, Scope(), cost, (tuple(tokens(text)), None))


def numbers(store: ProgramStore, owner: int = 0) -> list[int]:
    return [stored.number for stored in store.lines(owner)]


def test_lines_are_kept_in_numeric_order(store: ProgramStore) -> None:
    for number in (30, 10, 20, 15):
        store.put(0, line(number))
    assert numbers(store) == [10, 15, 20, 30]
    store.delete(0, 15)
    store.delete(0, 99)
    assert numbers(store) == [10, 20, 30]
    assert store.is_empty(1)


def test_memory_follows_what_is_stored(store: ProgramStore) -> None:
    free = store.storage.free_program
    store.put(0, line(10, cost=100))
    store.put(0, line(20, cost=50))
    assert free(0) == 65536 - 150
    store.put(0, line(10, cost=30))
    assert free(0) == 65536 - 80
    store.delete(0, 20)
    assert free(0) == 65536 - 30
    store.erase(0)
    assert free(0) == 65536
    assert store.is_empty(0)


def test_a_line_without_room_changes_nothing(store: ProgramStore) -> None:
    store.put(0, line(10, cost=65536))
    with pytest.raises(CardError, match="Out of memory"):
        store.put(0, line(20))
    with pytest.raises(CardError, match="Out of memory"):
        store.put(0, line(10, cost=65540))
    assert numbers(store) == [10]
    store.put(0, line(10, cost=4))


def test_hidden_numbers_go_on_in_tens(store: ProgramStore) -> None:
    assert store.next_number(0) == 10
    store.put(0, line(10))
    assert store.next_number(0) == 20
    store.put(0, line(15))
    assert store.next_number(0) == 20


def test_every_change_sets_program_modified(store: ProgramStore) -> None:
    words = store.storage.memory.I
    changes: list[Callable[[], None]] = [
        lambda: store.put(3, line(10)),
        lambda: store.delete(3, 10),
        lambda: store.erase(3),
    ]
    for change in changes:
        words[pf.word[3]] = 0
        change()
        assert words[pf.word[3]] == pf.PROGRAM_MODIFIED


@pytest.mark.parametrize(
    ("text", "rest"),
    [
        ("PROGRAM", ""),
        ("  program  ", ""),
        (":PROGRAM", ""),
        ("PROGRAM0_start", "_start"),
        ("PROGRAM 3 _a", "_a"),
        ("PROGRAM : REM main", ": REM main"),
        ("PROGRAMS", None),
        ("PROG 0", None),
        ("10 PROGRAM", None),
    ],
)
def test_the_word_program_opens_free_form_entry(text: str, rest: str | None) -> None:
    assert opens_capture(text) == rest


def test_line_numbers_are_whole_and_have_six_digits() -> None:
    assert [line_number(tokens(text)[0]) for text in ("1", "100 X", "999999")] == [1, 100, 999999]
    for text in ("0", "1000000", "1.5", "1e3", "&H10"):
        with pytest.raises(CardError, match="Syntax error"):
            line_number(tokens(text)[0])


def test_a_password_is_taken_back_with_itself_only(store: ProgramStore) -> None:
    store.check_readable()
    store.protect("secret")
    with pytest.raises(CardError, match="Program is protected"):
        store.check_readable()
    with pytest.raises(CardError, match="Invalid password"):
        store.unprotect("Secret")
    store.unprotect("secret")
    store.check_readable()
