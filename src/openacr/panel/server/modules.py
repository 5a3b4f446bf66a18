"""Modules that a page of the screens imports: browsers may fetch them all at once."""

import html
import posixpath
import re
from collections.abc import Callable, Iterator

ENTRY = re.compile(r'<script type="module" src="/([^"]+)"></script>')
STATIC = re.compile(r'^(?:import|export)\b[^"()]*"(\.{1,2}/[^"]+)"', re.MULTILINE)
ANY = re.compile(r'\b(?:import\(|import|from)\s*"(\.{1,2}/[^"]+)"')
Read = Callable[[str], str]


def with_modules(page: str, read: Read) -> str:
    """A page with a link for every module of its start.

    Those are the imports of its script, also the later ones, with all that they cannot do without;
    the browser would find them only module by module.
    """
    entry = ENTRY.search(page)
    if entry is None:
        return page
    links = "".join(
        f'\n    <link rel="modulepreload" href="/{html.escape(path)}">'
        for path in _needed(entry[1], read)
    )
    return page[: entry.start()] + entry[0] + links + page[entry.end() :]


def _needed(entry: str, read: Read) -> Iterator[str]:
    """The modules of the start, without the script itself.

    Those without which the script does not begin come first: it opens the link. The others come in
    the order of its later imports, each with all it needs.
    """
    found = {entry}
    for pattern in (STATIC, ANY):
        waiting = list(_imports(entry, read, pattern))
        while waiting:
            path = waiting.pop(0)
            if path in found:
                continue
            found.add(path)
            yield path
            waiting = [*_imports(path, read, STATIC), *waiting]


def _imports(path: str, read: Read, pattern: re.Pattern[str]) -> Iterator[str]:
    folder = posixpath.dirname(path)
    for match in pattern.finditer(read(path)):
        yield posixpath.normpath(f"{folder}/{match[1]}")
