"""Pages that stand alone: a template with data, and the modules and sheets of the panel's screens.

A module is a `data:` address of an import map, so that a page opened from a file needs nothing
else. Titles and data that come from files cannot change the page.
"""

import html
import posixpath
import re
from functools import partial
from importlib.resources import files
from typing import Any
from urllib.parse import quote

import msgspec

WEB = files("openacr.panel").joinpath("web")
ENTRY = re.compile(r'import "openacr/([^"]+)"')
IMPORT = re.compile(r'(\b(?:from|import)\s*\(?\s*)"(\.{1,2}/[^"]+)"')
SAFE = " !$&'()*+,-./;?@[]^_`{|}~"  # what an address may have; no ":", so that no text in it is one


def filled(template: str, title: str, data: dict[str, Any], *sheets: str) -> str:
    """Put title, data, modules and style sheets (of the panel) into a template, all at once.

    None is searched for the marks of the others, and no text in them can close a script or open
    a remark in it.
    """
    text = files("openacr.cli.plots").joinpath(template).read_text(encoding="utf-8")
    entry = ENTRY.search(text)
    parts = {
        "TITLE": html.escape(title),
        "DATA": _script(data),
        "STYLE": "".join(_text(sheet) for sheet in sheets),
        "MODULES": _script({"imports": modules(entry[1]) if entry else {}}),
    }
    return re.sub("@(TITLE|DATA|STYLE|MODULES)@", lambda mark: parts[mark[1]], text)


def _script(data: object) -> str:
    return msgspec.json.encode(data).decode().replace("<", "\\u003c")


def modules(entry: str) -> dict[str, str]:
    """The addresses of a module of the panel and of all that it imports, by name."""
    found: dict[str, str] = {}
    waiting = [entry]
    while waiting:
        path = waiting.pop()
        if f"openacr/{path}" in found:
            continue
        folder = posixpath.dirname(path)
        text = _text(path)
        imported = [posixpath.normpath(f"{folder}/{each[2]}") for each in IMPORT.finditer(text)]
        named = IMPORT.sub(partial(_named, folder=folder), text)
        found[f"openacr/{path}"] = f"data:text/javascript,{quote(named, safe=SAFE)}"
        waiting += imported
    return found


def _named(found: re.Match[str], *, folder: str) -> str:
    """An import by name: an address has no folders to count from."""
    return f'{found[1]}"openacr/{posixpath.normpath(f"{folder}/{found[2]}")}"'


def _text(path: str) -> str:
    return WEB.joinpath(path).read_text(encoding="utf-8")
