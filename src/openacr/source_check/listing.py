"""Controller files as a card lists them: programs and lines as text, PLCs as ladders."""

from collections.abc import Iterator

from openacr.basic.language.lister import Lister
from openacr.basic.language.loader import FileLine
from openacr.basic.language.registry import Level
from openacr.plc.ladder import draw
from openacr.source_check.source import Reader
from openacr.source_check.texts import Text


def listing(reader: Reader) -> Iterator[str]:
    """Write everything that was read as LIST shows it."""
    for _, text in listed(reader):
        yield text


def listed(reader: Reader) -> Iterator[tuple[FileLine, str]]:
    """Every line that was read, and how LIST shows it."""
    lister = Lister(reader.aliases)
    for part in reader.parts:
        if isinstance(part, Text):
            shown = lister.program(part.stored())
            yield from zip((line.place for line in part.in_order()), shown, strict=True)
        else:
            yield part.line, lister.line(part.tokens)


def ladders(reader: Reader) -> Iterator[str]:
    """Draw the PLCs that were read."""
    for (level, number), text in reader.texts.items():
        if level is Level.PLC:
            yield f"PLC{number}"
            yield from draw(text.rungs())
