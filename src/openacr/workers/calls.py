"""What goes to worker processes, and what comes back."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")
Call = Callable[[Task], Result]


@dataclass(frozen=True, slots=True)
class Done(Generic[Task, Result]):
    """A task with its result."""

    task: Task
    result: Result


@dataclass(frozen=True, slots=True)
class Lost(Generic[Task]):
    """A task without a result: its process died each time, or it raised an error."""

    task: Task
    reason: str


class Pool(AbstractContextManager["Pool"], Protocol):
    """Worker processes; at the end of its context they are gone."""

    deaths: int  # of worker processes so far; their tasks were done again elsewhere

    @property
    def size(self) -> int:
        """How many tasks are done at the same time."""

    def results(
        self, call: Call[Task, Result], tasks: Iterable[Task]
    ) -> Iterator[Done[Task, Result] | Lost[Task]]:
        """The results of all tasks, each once, as they come; `tasks` is read as needed."""
