"""Counts in messages, words for a shell."""

from pathlib import Path

import pytest

from openacr import wording
from openacr.wording import as_typed, counted


@pytest.mark.parametrize(
    ("cnt", "noun", "text"),
    [
        (1, "error", "1 error"),
        (0, "error", "0 errors"),
        (2, "error", "2 errors"),
        (1, "entry", "1 entry"),
        (3, "entry", "3 entries"),
        (2, "display", "2 displays"),
    ],
)
def test_one_is_singular_and_all_others_are_plural(cnt: int, noun: str, text: str) -> None:
    assert counted(cnt, noun) == text


@pytest.mark.parametrize(
    ("is_windows", "word", "typed"),
    [
        (False, Path("mill"), "mill"),
        (False, Path("shop/my mill"), "'shop/my mill'"),
        (False, "tom's", "'tom'\"'\"'s'"),
        (True, "mill", "mill"),
        (True, "C:\\my mill", '"C:\\my mill"'),
        (True, "tom's", "tom's"),
    ],
)
def test_a_path_is_shown_as_the_shell_takes_it(
    monkeypatch: pytest.MonkeyPatch, is_windows: bool, word: object, typed: str
) -> None:
    monkeypatch.setattr(wording, "WINDOWS", is_windows)
    assert as_typed(word) == typed
