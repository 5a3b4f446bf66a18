"""Templates of text files: `%for`, `%if`, `%else` and `%end` on lines of their own, `$values`.

`%for axes` repeats its lines for each table of the list `axes`, whose values add to the others.
`%if name` and `%if not name` keep their lines where the value is true. A value is written
`$name` or `${name}`; a name that is not there is an error.
"""

from collections.abc import Iterator, Mapping
from string import Template
from typing import Any, TypeAlias

Values: TypeAlias = Mapping[str, Any]


def render(template: str, values: Values) -> str:
    """Fill a template; KeyError or ValueError where the template is wrong."""
    lines = iter(template.splitlines(keepends=True))
    text, end = _block(lines, values, is_kept=True)
    if end:
        raise ValueError(f"{end} without its beginning")
    return text


def _block(lines: Iterator[str], values: Values, *, is_kept: bool) -> tuple[str, str]:
    """The text up to the line that ends this block, and that line."""
    text = ""
    for line in lines:
        words = line.split() if line.startswith("%") else []
        if not words:
            text += Template(line).substitute(values) if is_kept else ""
        elif words[0] == "%for":
            text += _repeated(lines, words[1], values, is_kept=is_kept)
        elif words[0] == "%if":
            text += _chosen(lines, words[1:], values, is_kept=is_kept)
        else:
            return text, words[0]
    return text, ""


def _repeated(lines: Iterator[str], name: str, values: Values, *, is_kept: bool) -> str:
    inner = []
    depth = 1
    for line in lines:
        depth += line.startswith(("%for", "%if")) - line.startswith("%end")
        if depth == 0:
            break
        inner.append(line)
    rows = values[name] if is_kept else ()
    return "".join(render("".join(inner), {**values, **row}) for row in rows)


def _chosen(lines: Iterator[str], words: list[str], values: Values, *, is_kept: bool) -> str:
    holds = is_kept and bool(values[words[-1]]) is (words[0] != "not")
    text, end = _block(lines, values, is_kept=holds)
    if end == "%else":
        other, end = _block(lines, values, is_kept=is_kept and not holds)
        text += other
    if end != "%end":
        raise ValueError(f"%if {' '.join(words)} without its %end")
    return text
