"""Counts in messages."""

import pytest

from openacr.wording import counted


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
