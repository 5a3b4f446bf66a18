"""Fill the templates of pages: titles and data that come from files cannot change the page."""

import html
import re
from importlib.resources import files
from typing import Any

import msgspec


def filled(template: str, title: str, data: dict[str, Any]) -> str:
    """Put a title and the data of the script into a template, both at once.

    Neither is searched for the marks of the other, and no text in the data can close the
    script or open a remark in it.
    """
    text = files("openacr.cli.plots").joinpath(template).read_text(encoding="utf-8")
    script = msgspec.json.encode(data).decode().replace("<", "\\u003c")
    parts = {"@TITLE@": html.escape(title), "@DATA@": script}
    return re.sub("@TITLE@|@DATA@", lambda mark: parts[mark[0]], text)
