"""A form: which cells it has, who may change them, and how they are grouped."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from openacr.panel.roles import Role
from openacr.sysvar import Store
from openacr.sysvar.schema import AXES, Tab
from openacr.sysvar.tabs import AXIS


class Group(NamedTuple):
    """Rows under a title."""

    title: str
    cells: Sequence[int]


Groups = Callable[[Store, int | None], Sequence[Group]]  # of an axis, None: of all


@dataclass(frozen=True, slots=True)
class Form:
    """One page of the screens."""

    name: str
    title: str
    section: str  # the menu it belongs to
    role: Role  # that may change it
    groups: Groups
    is_per_axis: bool = False
    is_paged: bool = False
    key: str = ""
    implied: Mapping[int, float] = field(default_factory=dict)  # cells set by SAVE of any others

    def all_cells(self, store: Store) -> frozenset[int]:
        """All cells that may be changed on this form."""
        return frozenset(cell for group in self.groups(store, None) for cell in group.cells)


def axes_of(store: Store) -> list[tuple[int, str]]:
    """Index and name of the configured axes."""
    return [
        (axis, store.read_text(AXIS.name[axis]))
        for axis in range(AXES)
        if store.read(AXIS.configured[axis])
    ]


def per_axis(tab: Tab, *, hidden: frozenset[int] = frozenset()) -> Groups:
    """The rows of a tab that has a thousand numbers for each axis."""

    def groups(_store: Store, axis: int | None) -> list[Group]:
        chosen = range(AXES) if axis is None else (axis,)
        return [Group("", [n for a in chosen for n in _cells(tab, hidden, axis=a)])]

    return groups


def whole(tab: Tab, *, hidden: frozenset[int] = frozenset(), by_axis: bool = False) -> Groups:
    """All rows of a tab, without its long series; those of axes come in groups of their own."""

    def groups(store: Store, _axis: int | None) -> list[Group]:
        found = [Group("", list(_cells(tab, hidden, axis=None)))]
        if by_axis:
            for axis, name in axes_of(store):
                found.append(Group(name, list(_cells(tab, hidden, axis=axis))))
        return [group for group in found if group.cells]

    return groups


def listed(title: str, cells: Sequence[int]) -> Groups:
    """The cells of a table, page by page."""
    return lambda _store, _axis: [Group(title, cells)]


def by_axis(*rows: tuple[str, Sequence[int]]) -> Groups:
    """Rows that have one cell for each axis."""

    def groups(store: Store, _axis: int | None) -> list[Group]:
        axes = [axis for axis, _ in axes_of(store)]
        return [Group(title, [cells[axis] for axis in axes]) for title, cells in rows]

    return groups


MOST_IN_SERIES = 32  # longer series have a form of their own


def _cells(tab: Tab, hidden: frozenset[int], *, axis: int | None) -> Iterator[int]:
    for offset, (row, of_axis, _index) in sorted(tab.cells.items()):
        number = tab.base + offset
        if number in hidden or row.count > MOST_IN_SERIES or "reserved" in row.name.lower():
            continue
        if of_axis == axis and (axis is None or row.is_per_axis):
            yield number
