"""Sums of the first n of many numbers, of which some change now and then.

Both changing a number and finding a sum take a number of steps that grows with the logarithm of the
count (a binary indexed tree, Fenwick 1994): entry i, counted from 1, holds the sum of the numbers
from i - (i & -i) up to i - 1.
"""


class RunningSums:
    """The sums of `count` numbers, all 0 at first."""

    def __init__(self, count: int) -> None:
        self._sums = [0] * (count + 1)

    def add(self, index: int, amount: int) -> None:
        """Add to the number at an index."""
        place = index + 1
        while place < len(self._sums):
            self._sums[place] += amount
            place += place & -place

    def before(self, index: int) -> int:
        """The sum of all numbers before an index."""
        total = 0
        while index:
            total += self._sums[index]
            index &= index - 1
        return total

    def find(self, total: int) -> int:
        """The first index up to and including which the sum exceeds `total`; the count if none."""
        index, step = 0, 1 << len(self._sums).bit_length()
        while step:
            ahead = index + step
            if ahead < len(self._sums) and self._sums[ahead] <= total:
                index, total = ahead, total - self._sums[ahead]
            step >>= 1
        return index
