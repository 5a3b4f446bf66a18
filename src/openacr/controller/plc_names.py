"""What the words of AcroBASIC and the aliases of a card mean in a PLC."""

from collections.abc import Mapping

from openacr.basic import registry
from openacr.basic.aliases import whole_number
from openacr.basic.nodes import Expr
from openacr.plc.reader import Names


def plc_names(aliases: Mapping[str, Expr]) -> Names:
    """The names a line of a PLC may use."""
    return Names(
        alias=lambda name: whole_number(aliases.get(name)),
        is_command=lambda word: word in registry.keywords(),
    )
