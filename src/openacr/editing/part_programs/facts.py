"""What a line of a part program means for the lines around it, known from its text alone."""

import re
from functools import lru_cache

from msgspec import Struct

from openacr.editing.part_programs.marks import routine_name

_SAYS = re.compile(r"\s*(?:[NO]|[(;])", re.IGNORECASE)
_LABEL = re.compile(r"\s*N\s*0*([1-9]\d{0,5})(?![\d.])\s*(.*)", re.IGNORECASE)
_ROUTINE = re.compile(r"\s*(?:N\s*\d+\s*)?(O\s*(?:<[^<>]*>|\d+))\s*([A-Za-z]*)", re.IGNORECASE)
_REMARK = re.compile(r"\s*(?:\(([^)]*)\)|;(.*))\s*$")
_OPENS = frozenset(("SUB", "IF", "REPEAT", "DO"))
_CLOSES = frozenset(("ENDSUB", "ENDIF", "ENDREPEAT", "ENDWHILE"))


class Facts(Struct, frozen=True):
    """What one line says; `kind` is what its O-word does."""

    label: str = ""
    routine: str = ""
    kind: str = ""
    remark: str = ""
    is_bare: bool = False  # nothing but a label and a remark
    is_remark: bool = False

    @property
    def opens(self) -> bool:
        """Whether a structure begins."""
        return self.kind in _OPENS

    @property
    def closes(self) -> bool:
        """Whether a structure ends."""
        return self.kind in _CLOSES


@lru_cache(maxsize=1 << 16)
def facts_of(line: str) -> Facts | None:
    """The facts of a line; None if it says nothing."""
    if not _SAYS.match(line):
        return None
    if remark := _REMARK.match(line):
        return Facts(remark=(remark[1] or remark[2] or "").strip(), is_remark=True)
    label, routine = _LABEL.match(line), _ROUTINE.match(line)
    rest = _REMARK.match(label[2]) if label else None
    if not (label or routine):
        return None
    return Facts(
        label=label[1] if label else "",
        routine=routine_name(routine[1]) if routine else "",
        kind=routine[2].upper() if routine else "",
        remark=(rest[1] or rest[2] or "").strip() if rest else "",
        is_bare=label is not None and (rest is not None or not label[2].strip()),
    )
