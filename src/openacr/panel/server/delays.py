"""Delays after wrong passwords, by the address they come from."""

FIRST_DELAY_S, LONGEST_DELAY_S = 0.5, 30.0
FREE_TRIES = 2
MOST_ADDRESSES = 1000


class Delays:
    """How long each address has to wait: from the third wrong password on 1 s, 2 s ... 30 s."""

    def __init__(self) -> None:
        self._failed: dict[str, tuple[int, float]] = {}  # by address: how often, until when

    def wait_s(self, address: str, now_s: float) -> float:
        """How long an address has to wait before the next try."""
        return max(0.0, self._failed.get(address, (0, 0.0))[1] - now_s)

    def note_failure(self, address: str, now_s: float) -> int:
        """Note a wrong password; how many there were of this address in a row."""
        tries = self._failed.get(address, (0, 0.0))[0] + 1
        over = max(0, tries - FREE_TRIES)
        wait_s = min(FIRST_DELAY_S * 2.0**over, LONGEST_DELAY_S) if over else 0.0
        if len(self._failed) >= MOST_ADDRESSES:
            self._failed.clear()
        self._failed[address] = (tries, now_s + wait_s)
        return tries

    def forget(self, address: str) -> None:
        """Forget the failures of an address, which has given the right password."""
        self._failed.pop(address, None)
