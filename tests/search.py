"""Searches: `make test` tries a part of their cases, `make soak` all of them.

A case that is drawn at random is another one in every run, so that a small draw finds in many runs
what a large one finds in few. Of cases in a row, as the ticks of a path, every sixth is tried.
"""

import os
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import pytest
from hypothesis import settings

from openacr.compiled import is_compiled

Test = TypeVar("Test", bound=Callable[..., Any])
IS_WHOLE = os.environ.get("OPENACR_SEARCH") == "whole"  # as `make soak` sets it
PART = 6
SLOW = 150  # plain Python is that many times slower
FEW = 2


def examples(whole: int, part: int = PART) -> int:
    """How many of `whole` cases are tried: one of `part`; plain Python tries few."""
    if not is_compiled:
        return max(FEW, whole // SLOW)
    return whole if IS_WHOLE else max(FEW, -(-whole // part))


def search(whole: int, *, part: int = PART, **others: Any) -> Callable[[Test], Test]:
    """A test of Hypothesis with `whole` examples, and other settings of Hypothesis.

    `make test` tries one of `part` of them: a slow test names a larger one.
    """

    def of(test: Test) -> Test:
        marked: Test = pytest.mark.search(
            settings(max_examples=examples(whole, part), **others)(test)
        )
        return marked

    return of


def stride(whole: int) -> int:
    """Every which tick is tried of a path that is tried at every `whole`-th."""
    if not is_compiled:
        return 50 * whole
    return whole if IS_WHOLE else PART * whole


def sparse(cases: Sequence[Any], every: int = PART) -> list[Any]:
    """Cases of a parameter: one of every few, the others in `make soak` alone."""
    found: list[Any] = []
    for place, case in enumerate(cases):
        values = case if isinstance(case, tuple) else (case,)
        found.append(pytest.param(*values, marks=[pytest.mark.soak] if place % every else []))
    return found
