"""Who is attached to what: programs, masters, slaves and the names of axes.

The numbers the servo interrupt needs are rows of the memory (written by `attach.py`); the
names exist only here.
"""

from dataclasses import dataclass, field
from typing import Annotated, TypeAlias

from msgspec import Meta, Struct

_Number: TypeAlias = Annotated[int, Meta(ge=0, le=15)]  # of a program, master, slave or axis
AttachmentsState: TypeAlias = tuple[
    list[tuple[_Number, _Number]],  # program and its master
    list[tuple[_Number, _Number, _Number, str]],  # program, slave, axis and its name
]


class Slave(Struct, frozen=True):
    """One slave of a program's master."""

    number: int
    axis: int
    name: str


@dataclass(slots=True)
class Attachments:
    """Masters and slaves by program."""

    _masters: dict[int, int] = field(default_factory=dict)
    _slaves: dict[int, dict[int, Slave]] = field(default_factory=dict)
    _names: dict[int, frozenset[str]] = field(default_factory=dict, compare=False, repr=False)

    def master(self, program: int) -> int | None:
        """The master of a program, if it has one."""
        return self._masters.get(program)

    def program(self, master: int) -> int | None:
        """The program a master is attached to."""
        for program, attached in self._masters.items():
            if attached == master:
                return program
        return None

    def slaves(self, program: int) -> tuple[Slave, ...]:
        """Slaves of a program in slave order."""
        slaves = self._slaves.get(program, {})
        return tuple(slaves[number] for number in sorted(slaves))

    def axes(self, program: int) -> tuple[tuple[str, int], ...]:
        """Name and number of every axis of a program in slave order."""
        return tuple((slave.name, slave.axis) for slave in self.slaves(program))

    def names(self, program: int) -> frozenset[str]:
        """The names of the axes of a program in upper case; asked for with every line."""
        known = self._names.get(program)
        if known is None:
            known = frozenset(name.upper() for name, _ in self.axes(program))
            self._names[program] = known
        return known

    def axis(self, program: int, name: str) -> int | None:
        """The axis a program calls by `name` (any case)."""
        upper = name.upper()
        for slave in self._slaves.get(program, {}).values():
            if slave.name.upper() == upper:
                return slave.axis
        return None

    def slave_of(self, program: int, axis: int) -> int | None:
        """The slave number of an axis in a program."""
        return next((s.number for s in self.slaves(program) if s.axis == axis), None)

    def owner(self, axis: int) -> int | None:
        """The program whose master moves an axis."""
        return next(
            (
                p
                for p, slaves in self._slaves.items()
                if any(s.axis == axis for s in slaves.values())
            ),
            None,
        )

    def put_master(self, program: int, master: int) -> None:
        """Record a master."""
        self._masters[program] = master

    def put_slave(self, program: int, slave: Slave) -> None:
        """Record a slave."""
        self._slaves.setdefault(program, {})[slave.number] = slave
        self._names.clear()

    def drop_slave(self, program: int, number: int) -> None:
        """Forget a slave."""
        self._slaves.get(program, {}).pop(number, None)
        self._names.clear()

    def drop_program(self, program: int) -> None:
        """Forget master and slaves of a program."""
        self._masters.pop(program, None)
        self._slaves.pop(program, None)
        self._names.clear()

    def clear(self) -> None:
        """Forget everything."""
        self._masters.clear()
        self._slaves.clear()
        self._names.clear()

    def state(self) -> AttachmentsState:
        """Everything in its order, for a snapshot."""
        slaves = [
            (program, each.number, each.axis, each.name)
            for program, found in self._slaves.items()
            for each in found.values()
        ]
        return list(self._masters.items()), slaves

    @classmethod
    def from_state(cls, state: AttachmentsState) -> "Attachments":
        """What `state` described."""
        masters, slaves = state
        made = cls(dict(masters))
        for program, number, axis, name in slaves:
            made.put_slave(program, Slave(number, axis, name))
        return made
