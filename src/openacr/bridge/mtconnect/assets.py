"""The assets an agent keeps: a cutting tool for each tool of the tool table."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from openacr.bridge.mtconnect.model import CUTTING_TOOL
from openacr.bridge.tools import CuttingTool
from openacr.mill.config.tools import MOST_TOOLS


@dataclass(frozen=True, slots=True)
class Asset:
    """A tool, where it is, and when it was last changed."""

    id: str
    stamp: str
    tool: CuttingTool
    is_in_spindle: bool = False
    is_removed: bool = False


@dataclass(frozen=True, slots=True)
class Changes:
    """The ids of assets that a reading of the tool table has changed."""

    changed: tuple[str, ...]  # or added
    removed: tuple[str, ...]


class Assets:
    """The tools of one machine. Those that are removed stay known, at their place."""

    size = MOST_TOOLS  # so that none is ever pushed out
    type = CUTTING_TOOL

    def __init__(self, machine: str) -> None:
        self._machine = machine
        self._kept: dict[str, Asset] = {}  # the newest change last

    @property
    def count(self) -> int:
        """How many there are, without the removed ones."""
        return sum(not each.is_removed for each in self._kept.values())

    def update(self, tools: Iterable[CuttingTool], in_spindle: int | None, stamp: str) -> Changes:
        """Take over the tool table as it is now, and the number of the tool in the spindle."""
        table = {f"{self._machine}.T{tool.number}": tool for tool in tools}
        gone = [each for each in self._kept.values() if each.id not in table]
        removed = [each for each in gone if not each.is_removed]
        for each in removed:
            self._kept[each.id] = replace(each, stamp=stamp, is_removed=True)
        assets = (
            Asset(name, stamp, tool, tool.number == in_spindle) for name, tool in table.items()
        )
        changed = [each for each in assets if not self._has(each)]
        for each in changed:
            self._kept.pop(each.id, None)
            self._kept[each.id] = each
        return Changes(tuple(each.id for each in changed), tuple(each.id for each in removed))

    def _has(self, asset: Asset) -> bool:
        kept = self._kept.get(asset.id)
        return kept is not None and replace(kept, stamp=asset.stamp) == asset

    def named(self, name: str) -> Asset | None:
        """The asset with an id, a removed one as well."""
        return self._kept.get(name)

    def newest(self, count: int, *, with_removed: bool) -> list[Asset]:
        """The assets that were changed last, the newest first."""
        found = [each for each in self._kept.values() if with_removed or not each.is_removed]
        return found[::-1][:count]
