"""Details of a short part of a history: curves, distances, lines, and what is looked for."""

from typing import Any

import numpy as np
import pytest
from tests.controller.hosts import X_AND_Y, Host

from openacr.controller import Controller
from openacr.map.memory import flag_place
from openacr.timeline import Course, Timeline
from openacr.timeline.details import change_of, details, line_of

OUT = 40
LINES = ("10 SET 40", "20 DWL 0.1", "30 CLR 40", "40 DWL 0.1", "50 GOTO 10")


@pytest.fixture(scope="module")
def timeline() -> Timeline:
    """X goes to 3 and back to 1 while program 4 switches an output."""
    card = Controller()
    host = Host(card)
    host.type(*X_AND_Y)
    timeline = Timeline(card)
    host.type("PROG4", *LINES)
    timeline.advance(100)
    host.type("RUN", "PROG0", "X3", "X1")
    timeline.advance(4000)
    return timeline


def whole(timeline: Timeline) -> tuple[Course, int, int]:
    first, last = timeline.branch.first.tick, timeline.branch.last.tick
    return timeline.course(0, first, last), first, last


def changes(timeline: Timeline) -> list[int]:
    """The ticks in which the output changes, found tick by tick."""
    course, first, last = whole(timeline)
    ticks = range(first, last + 1)
    seen = [bool(card.bit[OUT]) for card in course.moments(ticks)]
    return [tick for tick, a, b in zip(ticks[1:], seen, seen[1:], strict=False) if a != b]


def test_a_curve_has_the_distance_of_all_ticks_and_the_extremes_of_each_column(
    timeline: Timeline,
) -> None:
    found: dict[str, Any] = details(*whole(timeline), 50)
    (axis,) = found["axes"]
    assert axis["number"] == 0
    assert axis["distance"] == pytest.approx(5.0)
    assert [len(axis[key]) for key in ("places", "low", "high")] == [50, 50, 50]
    assert axis["places"][0] == 0.0
    assert axis["places"][-1] == pytest.approx(1.0)
    assert max(axis["high"]) == pytest.approx(-min(axis["low"]), rel=0.3)
    assert all(np.array(axis["low"]) <= np.array(axis["high"]))
    timeline.seek(timeline.branch.last)
    few = details(timeline.course(0, 200, 203), 200, 203, 50)
    assert [len(each["places"]) for each in few["axes"]] == [3]


def test_lines_are_slices_with_their_texts_and_all_of_them_count(timeline: Timeline) -> None:
    course, first, last = whole(timeline)
    (program,) = details(course, first, last, last - first + 1)["programs"]
    assert program["number"] == 4
    assert program["texts"] == {int(line[:2]): line[3:] for line in LINES}
    lines = [line for _tick, line in program["slices"]]
    ticks = [tick for tick, _line in program["slices"]]
    assert ticks == sorted(ticks)
    assert set(lines) >= {10, 20, 30, 40}
    assert program["lines"] >= len(lines)
    waits = [line for line in lines if line in (20, 40)]
    assert waits == [20, 40] * (len(waits) // 2) + [20] * (len(waits) % 2)
    (each_tick,) = details(course, first, last, last - first)["programs"]
    assert {line for _tick, line in each_tick["slices"]} == {20, 40}  # what a tick ends with
    (coarse,) = details(course, first, last, 4)["programs"]
    assert coarse["lines"] == program["lines"]
    assert len(coarse["slices"]) <= 5
    sets = [tick for tick, line in program["slices"] if line == 10]
    assert sets == changes(timeline)[::2]


def test_the_next_and_the_previous_change_of_a_flag_are_found_to_the_tick(
    timeline: Timeline,
) -> None:
    course, _first, last = whole(timeline)
    ticks = changes(timeline)
    assert len(ticks) > 4

    def sought(begin: int, end: int, *, is_last: bool) -> int | None:
        return change_of(course, *flag_place(OUT), begin, end, is_last=is_last)

    assert sought(ticks[1], last, is_last=False) == ticks[2]
    assert sought(ticks[1] - 1, last, is_last=False) == ticks[1]
    assert sought(ticks[0], ticks[3] - 1, is_last=True) == ticks[2]
    assert sought(ticks[0], ticks[3], is_last=True) == ticks[3]
    assert sought(ticks[1], ticks[2] - 1, is_last=False) is None


def test_a_line_of_a_program_is_found_in_both_directions(timeline: Timeline) -> None:
    course, first, last = whole(timeline)
    ups = changes(timeline)[::2]
    for is_last, expected in ((False, ups[0]), (True, ups[-1])):
        assert line_of(course, 4, 10, first, last, is_last=is_last) == expected
    assert line_of(course, 4, 15, first, last, is_last=False) is None
    assert line_of(course, 5, 10, first, last, is_last=False) is None
