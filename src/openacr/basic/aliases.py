"""Aliases: the names #DEFINE gives to parameters, flags, constants and variables."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from openacr.basic.nodes import Expr, Flag, Number, resolved
from openacr.basic.registry import keywords
from openacr.errors import CardError
from openacr.messages import ILLEGAL_NAME, OUT_OF_DEFINE_SPACE

LONGEST_ALIAS = 24


class Aliases:
    """All aliases of the card, valid in every program and on every channel.

    `capacity()` is the number DIM DEF has reserved. Names are case-sensitive, but none may
    spell like a keyword; newer models allow digits in them. `nodes` is what a line is parsed
    with; a mapping handed out never changes, so whoever keeps one keeps the meaning of that
    moment.
    """

    def __init__(self, capacity: Callable[[], int], *, has_digits: bool = False) -> None:
        self._capacity = capacity
        self._has_digits = has_digits
        self._nodes: dict[str, Expr] = {}
        self._texts: dict[str, str] = {}

    @property
    def nodes(self) -> Mapping[str, Expr]:
        """The meaning of every alias."""
        return self._nodes

    @property
    def numbered(self) -> frozenset[str]:
        """The names that hold digits: the lexer takes them apart, the parser together."""
        return numbered_names(self._nodes) if self._has_digits else frozenset()

    def define(self, name: str, target: Expr, text: str) -> None:
        """#DEFINE: give `target`, written as `text`, a name; a known name gets a new target."""
        check_name(name, has_digits=self._has_digits)
        if name not in self._nodes and len(self._nodes) >= self._capacity():
            raise CardError(OUT_OF_DEFINE_SPACE)
        self._nodes = self._nodes | {name: target}
        self._texts[name] = text

    def clear(self) -> None:
        """DEF CLEAR: forget all."""
        self._nodes = {}
        self._texts.clear()

    def line(self, name: str) -> str | None:
        """The definition of one alias as it is typed."""
        return f"#DEFINE {name} {self._texts[name]}" if name in self._texts else None

    def lines(self) -> Iterator[str]:
        """DEF: all definitions as they are typed, oldest first."""
        for name, text in self._texts.items():
            yield f"#DEFINE {name} {text}"

    def state(self) -> dict[str, tuple[Expr, str]]:
        """All aliases, for a snapshot."""
        return {name: (node, self._texts[name]) for name, node in self._nodes.items()}

    def restore(self, state: Mapping[str, tuple[Expr, str]]) -> None:
        """Take over what `state` returned."""
        self._nodes = {name: node for name, (node, _) in state.items()}
        self._texts = {name: text for name, (_, text) in state.items()}


def check_name(name: str, *, has_digits: bool = False) -> None:
    """Refuse a name that is too long, not of letters only, or a word of the language.

    With digits behind the first letter a name may not read as a word and its number, as
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
