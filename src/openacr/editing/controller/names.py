"""The aliases and axes that the controller files of a project define."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from openacr.basic.language.registry import Level
from openacr.editing.controller.outline import Outline
from openacr.editing.document import Document

UNKNOWN = -1


@dataclass(slots=True)
class ProjectNames:
    """Aliases with their targets, and axes by program."""

    aliases: dict[str, str] = field(default_factory=dict)
    axes: dict[int, dict[str, int]] = field(default_factory=dict)
    alias_names: frozenset[str] = frozenset()

    def axes_of(self, program: int) -> frozenset[str]:
        """The names of the axes of a program."""
        return frozenset(self.axes.get(program, ()))

    @property
    def all_axes(self) -> set[str]:
        """The names of the axes of all programs."""
        return {name for axes in self.axes.values() for name in axes}

    def axis(self, program: int, name: str) -> int:
        """The number of an axis; -1 if no file attaches it."""
        return self.axes.get(program, {}).get(name, UNKNOWN)


def names_of(files: Iterable[tuple[Document, Outline]]) -> ProjectNames:
    """The names that some files define."""
    found = ProjectNames()
    for _, outlined in files:
        for line, facts in outlined.facts:
            if facts.alias and facts.alias[1]:
                found.aliases[facts.alias[0]] = facts.alias[1]
            if facts.axis:
                section = outlined.section_at(line)
                if section.level is Level.PROG:
                    found.axes.setdefault(section.number, {})[facts.axis[0]] = facts.axis[1]
    found.alias_names = frozenset(found.aliases)
    return found
