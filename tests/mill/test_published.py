"""What is published of a run: each cell and variable is written when it changes, and only then."""

from typing import cast

import pytest

from openacr.client import ConnectionLostError
from openacr.mill.card.driver import MachineDriver
from openacr.mill.config.settings import Store
from openacr.mill.run.published import Published


class Log:
    """Takes writes and keeps them."""

    def __init__(self) -> None:
        self.lines: list[tuple[int, float]] = []

    def write(self, number: int, value: float) -> None:
        self.lines.append((number, value))


def test_what_has_changed_is_written_and_nothing_else() -> None:
    cells, card = Log(), Log()
    published = Published(cast(Store, cells), cast(MachineDriver, card))
    for value in (0.0, 0.0, 2.0, 2.0, 0.0):
        published.cell(244, value)
    assert cells.lines == [(244, 0.0), (244, 2.0), (244, 0.0)]
    published.cell(245, 0.0)  # each number by itself
    assert cells.lines[3:] == [(245, 0.0)]
    assert card.lines == []


def test_a_cell_and_a_variable_of_one_number_are_two_places() -> None:
    cells, card = Log(), Log()
    published = Published(cast(Store, cells), cast(MachineDriver, card))
    published.cell(95, 1.0)
    published.variable(95, 1.0)
    published.variable(95, 1.0)
    published.variable(95, 3.0)
    assert (cells.lines, card.lines) == ([(95, 1.0)], [(95, 1.0), (95, 3.0)])


def test_a_variable_that_could_not_be_written_is_written_once_more() -> None:
    class Failing(Log):
        def write(self, number: int, value: float) -> None:
            super().write(number, value)
            if len(self.lines) == 1:
                raise ConnectionLostError("gone")

    cells, card = Log(), Failing()
    published = Published(cast(Store, cells), cast(MachineDriver, card))
    with pytest.raises(ConnectionLostError):
        published.variable(95, 1.0)
    published.variable(95, 1.0)
    published.variable(95, 1.0)
    assert card.lines == [(95, 1.0), (95, 1.0)]
