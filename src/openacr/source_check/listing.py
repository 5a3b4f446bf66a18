"""Controller files as a card lists them: programs and lines as text, PLCs as ladders."""

from collections.abc import Iterator

from openacr.basic.language.lister import Lister
from openacr.basic.language.registry import Level
from openacr.plc.ladder import draw
from openacr.source_check.source import Reader


def listing(reader: Reader) -> Iterator[str]:
    """Write everything that was read as LIST shows it."""
    lister = Lister(reader.aliases)
    for part in reader.parts:
        if part.text is not None:
            yield from lister.program(part.text.stored())
        else:
            yield lister.line(part.tokens)


def ladders(reader: Reader) -> Iterator[str]:
    """Draw the PLCs that were read."""
    for (level, number), text in reader.texts.items():
        if level is Level.PLC:
            yield f"PLC{number}"
            yield from draw(text.rungs())
