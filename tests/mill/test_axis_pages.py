"""SERVO, AXES, HOME and JOG hold a set of values for each of eight axes."""

from collections.abc import Iterator

import pytest

from openacr.sysvar import Store
from openacr.sysvar.schema import CellKind
from openacr.sysvar.tabs import AXIS, HOME, JOG, SERVO
from openacr.sysvar.values import SettingError, Value

TABS = (SERVO, AXIS, HOME, JOG)
ROWS = [
    value
    for tab in TABS
    for value in vars(tab).values()
    if isinstance(value, range) and value != AXIS.name  # eight letters for eight axes: all taken
]


def others(store: Store, cell: int) -> Iterator[float]:
    """Values that a cell might take in place of its own."""
    parameter, old = store.parameter(cell), store.value(cell)
    assert not isinstance(old, str)
    if parameter.kind is CellKind.REAL:
        yield from (old + 0.0625, old - 0.0625)
    else:
        yield from (each for each in range(-1, 16) if each != old)


def change(store: Store, cell: int) -> float:
    """Give a cell another value that it takes; returns it."""
    for value in others(store, cell):
        try:
            store.write(cell, value)
        except SettingError:
            continue
        return value
    raise AssertionError(store.parameter(cell))


def limited() -> Store:
    """A store with soft limits: without any they cannot be switched on."""
    store = Store()
    for axis in range(8):
        store.write(AXIS.plus_soft_limit[axis], 10 + axis)
        store.write(AXIS.minus_soft_limit[axis], -10 - axis)
    return store


def values(store: Store, axis: int) -> list[Value]:
    return [store.value(row[axis]) for row in ROWS]


@pytest.mark.req("MILL-SYS-AXISPAGE")
def test_every_value_of_an_axis_is_its_own() -> None:
    assert len(ROWS) == 44
    assert {len(row) for row in ROWS} == {8}
    for axis in range(8):
        store = limited()
        before = [values(store, each) for each in range(8)]
        given = [change(store, row[axis]) for row in ROWS]
        after = [values(store, each) for each in range(8)]
        assert after.pop(axis) == given
        assert all(one != other for one, other in zip(given, before.pop(axis), strict=True))
        assert after == before
