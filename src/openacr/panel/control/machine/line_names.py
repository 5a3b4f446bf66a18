"""What inputs and outputs are called: by the aliases of the card, by the machine, by the card."""

from collections.abc import Mapping
from functools import cached_property

from openacr.client.names import item_names
from openacr.map import flags
from openacr.sysvar import Store
from openacr.sysvar.tabs import OFFSETS

NAMES = {"input": OFFSETS.input_name, "output": OFFSETS.output_name}


class LineNames:
    """Names of the inputs and outputs of a card; `aliases` with what each stands for."""

    def __init__(self, aliases: Mapping[str, str], store: Store) -> None:
        self._targets, self._store = aliases, store

    @cached_property
    def _aliases(self) -> dict[str, str]:
        return item_names(self._targets)

    def of(self, kind: str, number: int) -> tuple[str, str]:
        """The alias of a flag, else the name that the machine gives it, else ""; and the card's."""
        flag, own = flags()[number], NAMES[kind]
        name = self._aliases.get(f"BIT{number}", "")
        if not name and number < len(own):
            name = self._store.read_text(own[number])
        board = f"XIO {flag.index} " if flag.object.startswith("XIO") else ""
        return name, f"{board}{flag.name}"
