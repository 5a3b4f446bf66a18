"""What the words of AcroBASIC and the aliases of a card mean in a PLC."""

from collections.abc import Mapping

from msgspec import Struct

from openacr.basic.language import registry
from openacr.basic.language.aliases import whole_number
from openacr.basic.language.nodes import Expr


class PlcNames(Struct, frozen=True):
    """The names a line of a PLC may use."""

    aliases: Mapping[str, Expr]

    def number(self, name: str) -> int | None:
        """The flag or whole number that an alias stands for."""
        return whole_number(self.aliases.get(name))

    def is_command(self, word: str) -> bool:
        """Whether AcroBASIC knows the word."""
        return word in registry.keywords()
