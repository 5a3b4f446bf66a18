"""Lines of controller files as coverage counts them: executions and the outcomes of decisions."""

from __future__ import annotations

from dataclasses import dataclass, field

BRANCHES = 2
Place = tuple[str, int]  # file and line


@dataclass(slots=True)
class Condition:
    """The condition of an IF with THEN: how often it was computed, and how often it was true."""

    computed: int = 0
    true: int = 0

    @property
    def outcomes(self) -> list[int | None]:
        """How often it was true and how often false; None where it was never computed."""
        return [self.true, self.computed - self.true] if self.computed else [None, None]


@dataclass(slots=True)
class Contact:
    """A contact of a PLC, or an input of an output: whether it was on, and whether it was off."""

    name: str
    on: bool = False
    off: bool = False

    @property
    def outcomes(self) -> list[int | None]:
        """1 for each state it was in, on and off; None where it was never scanned."""
        return [int(self.on), int(self.off)] if self.on or self.off else [None, None]

    @property
    def remark(self) -> str:
        """The state it was never in: `LD 3 was never on`; empty after both or without a scan."""
        if self.on == self.off:
            return ""
        return f"{self.name} was {'always' if self.on else 'never'} on"


@dataclass(slots=True)
class Line:
    """A line of a file: how often it was executed, its decisions, and the lines executed next.

    Of a line of a PLC, `count` is 1 once it was scanned.
    """

    leads_on: bool = False  # one of two lines follows it
    conditions: tuple[Condition, ...] = ()
    contacts: tuple[Contact, ...] = ()
    count: int = 0
    next: set[Place] = field(default_factory=set)

    @property
    def branches(self) -> list[int | None]:
        """How often each branch was taken, two for each decision; None where none was made.

        Of a line that leads on, 1 for each of the lines that have followed it.
        """
        if self.leads_on:
            return [int(k < len(self.next)) if self.count else None for k in range(BRANCHES)]
        decisions: tuple[Condition | Contact, ...] = (*self.conditions, *self.contacts)
        return [times for decision in decisions for times in decision.outcomes]

    @property
    def taken(self) -> int:
        """How many of its branches were taken."""
        return sum(bool(times) for times in self.branches)

    @property
    def remarks(self) -> list[str]:
        """What its contacts and outputs were always, or never."""
        return [contact.remark for contact in self.contacts if contact.remark]
