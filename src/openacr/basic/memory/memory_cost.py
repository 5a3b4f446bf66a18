"""What everything costs in bytes of user memory: one row each."""

from msgspec import Struct

from openacr.lang.lexer import Token, TokenKind

SYSTEM_BYTES = 1048576
AUTOMATIC_SHARE_BYTES = 65536
STREAM_BYTES = 256


class Cost(Struct, frozen=True):
    """Bytes of `count` equal things: a fixed part and a part for each."""

    each: int
    fixed: int = 0

    def bytes(self, count: int) -> int:
        """Bytes of `count` of them; nothing at all for none."""
        return self.fixed + self.each * count if count else 0


LONG_VARIABLE = Cost(4)
SINGLE_VARIABLE = Cost(4)
DOUBLE_VARIABLE = Cost(8)
ARRAY_REFERENCES = Cost(4, fixed=4)
LONG_ARRAY = Cost(4, fixed=4)
SINGLE_ARRAY = Cost(4, fixed=4)
DOUBLE_ARRAY = Cost(8, fixed=4)
STRING_ARRAY_CHARACTERS = Cost(1)
GLOBAL_VARIABLE = Cost(8)
ALIAS = Cost(48, fixed=16)
BUFFERED_MOVE = Cost(136)
FLOW_LEVEL = Cost(4)
COMMAND = Cost(4)
OPERATOR = Cost(4)
LINE_NUMBER = Cost(4)
LONG_CONSTANT = Cost(4)
SINGLE_CONSTANT = Cost(4)
DOUBLE_CONSTANT = Cost(8)
STRING_HEADER = 4
PLC_INSTRUCTION = Cost(8)

_FREE_OPERATORS = frozenset("():;,#")


def string_bytes(length: int) -> int:
    """A string variable or constant of `length` characters."""
    return STRING_HEADER + length


def line_bytes(tokens: list[Token]) -> int:
    """A stored line: its number, then its tokens; separators and parentheses are free."""
    return LINE_NUMBER.each + sum(map(_token_bytes, tokens))


def _token_bytes(token: Token) -> int:
    if token.kind is TokenKind.WORD:
        return COMMAND.each
    if token.kind is TokenKind.NUMBER:
        return constant_bytes(token.value)
    if token.kind is TokenKind.OPERATOR:
        return 0 if token.text in _FREE_OPERATORS else OPERATOR.each
    if token.kind is TokenKind.END:
        return 0
    return string_bytes(len(str(token.value)))


def constant_bytes(value: str | int | float) -> int:
    """A number: LONG, else single where seven digits hold it exactly, else double."""
    if isinstance(value, int):
        return LONG_CONSTANT.each
    exact = float(f"{float(value):.7g}") == value
    return SINGLE_CONSTANT.each if exact else DOUBLE_CONSTANT.each
