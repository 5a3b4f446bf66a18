"""How many segments cams and ballscrew tables have, by the arithmetic of the card itself."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from openacr.basic.language.nodes import AxisRef, Block, Statement
from openacr.errors import CardError
from openacr.map.memory import Memory
from openacr.map.rows import tables
from openacr.motion.followers import cam
from openacr.source_check.cutoffs import statements
from openacr.source_check.numbers import literal

Names = Mapping[str, int | None]  # of axes; their numbers, where they are not computed
AXES = tables.COUNT // 2
_FIRST = {"CAM": 0, "BSC": cam.ballscrew(0)}  # tables
_CHANGES = (("DIM",), ("CLEAR",))


@dataclass(slots=True)
class Tables:
    """The tables of a card that was new before, as they are after the lines read so far.

    A table is known as long as its size is: one that is computed, or a command that depends on
    something, ends that until the table is cleared.
    """

    memory: Memory = field(default_factory=Memory)
    _unknown: set[int] = field(default_factory=set)

    def note(self, blocks: Iterable[Block], axes: Names) -> CardError | None:
        """Execute the DIM and CLEAR commands of a line; what the card says against one."""
        for block in blocks:
            for statement in block:
                if isinstance(statement, Statement):
                    try:
                        self._execute(statement, axes)
                    except CardError as error:
                        return error
                    for argument in statement.arguments:
                        for inner in statements(getattr(argument, "blocks", ())):
                            self._forget(inner, axes)
        return None

    def _execute(self, statement: Statement, axes: Names) -> None:
        is_clear = statement.command.words[-1] == "CLEAR"
        for table, size in _sizes(statement, axes):
            count = None if size is None else literal(size)
            if table is None or (count is None and not is_clear):
                self._lose(table)
            elif is_clear:
                self._unknown.discard(table)
                cam.clear(self.memory, table)
            elif count is not None and table not in self._unknown:
                cam.dimension(self.memory, table, count)

    def _forget(self, statement: Statement, axes: Names) -> None:
        for table, _ in _sizes(statement, axes):
            self._lose(table)

    def _lose(self, table: int | None) -> None:
        self._unknown.update(range(tables.COUNT) if table is None else (table,))


def _sizes(statement: Statement, axes: Names) -> Iterator[tuple[int | None, Any]]:
    """The table of each axis whose size a command changes, and the size as it is written.

    The table is None for that of an axis that is computed.
    """
    kind, *rest = statement.command.words
    if kind not in _FIRST or tuple(rest) not in _CHANGES:
        return
    items: Any = statement.arguments[0]
    for item in items:
        number = _number(item.axis, axes)
        is_query = item.argument is None and rest == ["DIM"]
        if not is_query and (number is None or number < AXES):
            yield None if number is None else _FIRST[kind] + number, item.argument


def _number(axis: AxisRef, axes: Names) -> int | None:
    return axes.get(axis.name) if axis.number is None else literal(axis.number)
