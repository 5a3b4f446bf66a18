"""Parts that several pages of the screens have in common: each is a file of its own."""

import re
from collections.abc import Callable

PART = re.compile(r"^ *<!-- include ([\w/.]+) -->\n", re.MULTILINE)
Read = Callable[[str], str]


def with_parts(page: str, read: Read) -> str:
    """A page with its parts: `<!-- include parts/head.html -->` as a line is that file."""
    return PART.sub(lambda found: read(found[1]), page)
