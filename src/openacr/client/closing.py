"""What ends with the block that opened it."""

from types import TracebackType
from typing import Self


class Closing:
    """`with` closes it, whatever ends the block."""

    def close(self) -> None:
        """Give up what is held; again does nothing."""
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
