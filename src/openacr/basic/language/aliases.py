"""Aliases: the names #DEFINE gives to parameters, flags, constants and variables."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from openacr.basic.language.nodes import Expr, Flag, Number, resolved
from openacr.basic.language.registry import keywords
from openacr.basic.language.scope import join_names
from openacr.errors import CardError
from openacr.lang.lexer import tokens
from openacr.messages import ILLEGAL_NAME, OUT_OF_DEFINE_SPACE

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

LONGEST_ALIAS = 24
_NONE: Mapping[str, Any] = {}


class Written(Struct, frozen=True, eq=False):
    """The target of an alias as it is listed, and what the aliases in it stood for."""

    text: str
    uses: Mapping[str, Written]


class Names(dict[str, Expr]):
    """The meaning of every alias at one moment, with how each was written; never changed."""

    __slots__ = ("written",)

    def __init__(
        self, meanings: Mapping[str, Expr] = _NONE, written: Mapping[str, Written] = _NONE
    ) -> None:
        super().__init__(meanings)
        self.written = written

    def plus(self, name: str, target: Expr, written: Written) -> Names:
        """These and one more, or one with another target."""
        return Names(self | {name: target}, {**self.written, name: written})


class Aliases:
    """All aliases of the card, valid in every program and on every channel.

    `capacity()` is the number DIM DEF has reserved. Names are case-sensitive, but none may
    spell like a keyword; newer models allow digits in them. `nodes` is what a line is parsed
    with; a mapping handed out never changes, so a caller that keeps one keeps the meaning of that
    moment.
    """

    def __init__(self, capacity: Callable[[], int], *, has_digits: bool = False) -> None:
        self._capacity = capacity
        self._has_digits = has_digits
        self._nodes = Names()

    @property
    def nodes(self) -> Names:
        """The meaning of every alias."""
        return self._nodes

    @property
    def numbered(self) -> frozenset[str]:
        """The names that hold digits: the lexer takes them apart, the parser together."""
        return self.numbered_in(self._nodes)

    def numbered_in(self, names: Names) -> frozenset[str]:
        """The same for other aliases."""
        return numbered_names(names) if self._has_digits else frozenset()

    def define(self, name: str, target: Expr, text: str) -> None:
        """#DEFINE: give `target`, written as `text`, a name; a known name gets a new target."""
        check_name(name, has_digits=self._has_digits)
        if name not in self._nodes and len(self._nodes) >= self._capacity():
            raise CardError(OUT_OF_DEFINE_SPACE)
        found = tokens(text)
        join_names(found, self.numbered)
        known = self._nodes.written
        uses = {token.text: known[token.text] for token in found if token.text in known}
        self._nodes = self._nodes.plus(name, target, Written(text, uses))

    def clear(self) -> None:
        """DEF CLEAR: forget all."""
        self._nodes = Names()

    def restore(self, names: Names) -> None:
        """Take over the aliases of a snapshot."""
        self._nodes = names

    def line(self, name: str) -> str | None:
        """The definition of one alias as it is typed."""
        written = self._nodes.written.get(name)
        return f"#DEFINE {name} {written.text}" if written else None

    def lines(self) -> Iterator[str]:
        """DEF: all definitions as they are typed, oldest first."""
        for name, written in self._nodes.written.items():
            yield f"#DEFINE {name} {written.text}"


def read_target(p: Parser) -> Expr:
    """What an alias is given to: an alias of an alias stands for what that one stands for."""
    return resolved(
        p.expressions.variable() if p.expressions.at_variable else p.expressions.value()
    )


def check_name(name: str, *, has_digits: bool = False) -> None:
    """Refuse a name that is too long, not of letters only, or a word of the language.

    With digits after the first letter a name may not read as a word and its number, as
    `P12` and `SET32` do.
    """
    allowed = name.isalnum() and name[0].isalpha() if has_digits else name.isalpha()
    is_word = name.rstrip("0123456789").upper() in keywords()
    if not (name.isascii() and allowed) or is_word or len(name) > LONGEST_ALIAS:
        raise CardError(ILLEGAL_NAME)


def numbered_names(names: Iterable[str]) -> frozenset[str]:
    """Those of some names that hold digits."""
    return frozenset(name for name in names if not name.isalpha())


def whole_number(node: Expr | None) -> int | None:
    """The flag or the whole number that an alias stands for; None for anything else."""
    target = None if node is None else resolved(node)
    if isinstance(target, Flag):
        target = resolved(target.index)
    value = target.value if isinstance(target, Number) else None
    return value if isinstance(value, int) else None
