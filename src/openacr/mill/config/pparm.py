"""Operator variables of the P PARM screen: P0..P99 on the card, P100..P199 in the store."""

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.errors import UserError
from openacr.mill.config.settings import Store
from openacr.sysvar.schema import CARD_VARIABLES
from openacr.sysvar.tabs import CELLS

LAST = CELLS.user_variables[0] - 1


class OperatorParameters:
    """Reads and writes operator variables on the card or in the store; nothing is cached."""

    def __init__(self, store: Store, card: Card | None = None) -> None:
        self._store = store
        self._card = card

    def read(self, n: int) -> float:
        """The present value."""
        if n not in CARD_VARIABLES:
            return self._store.read(self._offered(n))
        try:
            return float(self._at(n).read(n))
        except RefusedError:
            raise _undimensioned(n) from None

    def write(self, n: int, value: float) -> None:
        """Change a value at once."""
        if n not in CARD_VARIABLES:
            self._store.write(self._offered(n), value)
            return
        try:
            self._at(n).write(n, value)
        except RefusedError:
            raise _undimensioned(n) from None

    def _at(self, n: int) -> Card:
        if self._card is None:
            raise UserError(f"P{n} is on the card: name the card with --host")
        return self._card

    def _offered(self, n: int) -> int:
        if not 0 <= n <= LAST:
            raise UserError(
                f"P{n} is not an operator variable: P0 to P{LAST} are"
                " (`openacr sysvar` has the others)"
            )
        return n


def _undimensioned(n: int) -> UserError:
    return UserError(
        f"P{n}: the card has no such variable (DIM P({len(CARD_VARIABLES)}) creates it)"
    )
