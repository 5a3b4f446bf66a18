"""Base class of objects that a `with` block closes."""

from types import TracebackType
from typing import Self


class Closing:
    """An object that its `with` block closes, even on an exception."""

    def close(self) -> None:
        """Release all resources; calling it again has no effect."""
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
