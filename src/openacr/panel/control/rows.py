"""What reads parameters of a card: its link, or its memory where it is in this process."""

from collections.abc import Callable

Rows = Callable[[list[int]], list[float]]
