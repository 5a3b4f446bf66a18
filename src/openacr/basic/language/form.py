"""What every argument of a command can do, whatever it is: the forms are in `grammar/`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from openacr.messages import SYNTAX_ERROR, Message


class Form(ABC):
    """One argument of a command.

    `p` is the parser of the line (`language.parser`), `run` what handlers get (`vm.run`): both
    are made of commands, whose arguments are forms.
    """

    names_axes = False
    silent = False  # the handler gets nothing for it

    def __init__(self, name: str = "", *, optional: bool = False) -> None:
        self.name = name
        self.optional = optional

    @abstractmethod
    def starts(self, p: Any) -> bool:
        """Whether this argument begins at the cursor."""

    @abstractmethod
    def parse(self, p: Any) -> object:
        """Read the argument."""

    def evaluate(self, run: Any, read: Any) -> object:
        """What the handler gets; `read` is what `parse` returned, None if left out."""
        return read

    def missing(self, p: Any) -> Message:
        """The message when a required argument does not begin at the cursor."""
        return SYNTAX_ERROR
