"""The project speaks plain engineering English: words it does not use, and where each may occur."""

import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# A word or phrase that does not belong into the project, and what to write instead. Words are
# looked up in texts and in the words of names (`way_out`, `MovePieces`), phrases in texts only.
WORDS = {
    "behind": "after, beyond, past, beneath",
    "somebody": "operator, caller, host, user",
    "someone": "operator, caller, host, user",
    "anybody": "any host, any program",
    "anyone": "any host, any program",
    "nobody": "no operator, no caller, no host",
    "everybody": "all hosts",
    "everyone": "all hosts",
    "whoever": "the operator, the caller, the host",
    "told": "commanded, reported, informed",
    "bow": "arc",
    "bows": "arcs",
    "stretch": "segment, section, interval",
    "stretches": "segments, sections",
    "way": "path, distance, direction, manner",
    "ways": "paths, directions",
}
PHRASES = {
    "is none": "is absent, not configured, None",
    "are none": "are absent, not configured",
    "of ours": "our own",
    "so many": "the count",
    "in one go": "at once, together",
    "over and over": "repeatedly",
    "1 errors": "openacr.wording.counted",
    "1 warnings": "openacr.wording.counted",
    "pieces of a move": "segments of a move",
}
# Contexts in which a word means something else: what stands in the physical world, set phrases.
ALLOWED = re.compile(
    r"\b(?:under[ _]way|both ways|(?:in )?the same way|the other way|on (?:the|its|their) way"
    r"|by way of|ways? to|gives? way|behind the curtain|there\s+(?:is|are)\s+none)\b",
    re.IGNORECASE,
)
FILES = sorted(
    path
    for pattern in ("src/openacr/**/*.py", "tests/**/*.py", "docs/**/*.md", "*.md")
    for path in ROOT.glob(pattern)
    if path != Path(__file__)
)


def room_of(path: Path) -> str:
    """The package of a module, the folder of a test or page."""
    parts = path.relative_to(ROOT).parts
    return "/".join(parts[: min(len(parts) - 1, 4 if parts[0] == "src" else 2)]) or "."


ROOMS = sorted({room_of(path) for path in FILES})
SPLIT = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")
PATTERN = re.compile(r"\b(?:" + "|".join(map(re.escape, WORDS)) + r")\b", re.IGNORECASE)
SPACED = [each.replace(" ", r"[\s_]+") for each in PHRASES]
PHRASE = re.compile(r"\b(?:" + "|".join(SPACED) + r")\b")

# Only files that have a word, in a part of a name too, or a phrase are read by tokens.
ANYWHERE = re.compile(
    rf"(?:(?<![A-Za-z])|(?=[A-Z]))(?i:{'|'.join(map(re.escape, WORDS))})(?![a-z])"
    rf"|{'|'.join(SPACED)}"
)


def texts_and_names(path: Path) -> Iterator[tuple[int, str, bool]]:
    """Line, text, and whether it is a name: of a page the lines, of a module its tokens."""
    whole = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        yield 1, whole, False
        return
    if not ANYWHERE.search(ALLOWED.sub(blank, whole)):
        return
    for token in tokenize.generate_tokens(io.StringIO(whole).readline):
        if token.type == tokenize.NAME:
            yield token.start[0], token.string, True
        elif token.type in (tokenize.STRING, tokenize.COMMENT):
            yield token.start[0], token.string, False


def found(path: Path) -> list[str]:
    """Every word and phrase of the lists in a file, as `line: word: text around it`."""
    hits = []
    for line, text, is_name in texts_and_names(path):
        words = " ".join(SPLIT.findall(text)) if is_name else re.sub(r"[_\n]", blank, text)
        plain = ALLOWED.sub(blank, words)
        for pattern in (PATTERN,) if is_name else (PATTERN, PHRASE):
            for hit in pattern.finditer(plain):
                where = line + text.count("\n", 0, hit.start()) if not is_name else line
                around = text if is_name else text[max(0, hit.start() - 40) : hit.end() + 40]
                hits.append(f"{where}: {hit[0].lower()}: {' '.join(around.split())}")
    return hits


@pytest.mark.parametrize("room", ROOMS)
def test_only_words_that_an_engineer_reads_at_once(room: str) -> None:
    files = [path for path in FILES if room_of(path) == room]
    assert [f"{path.relative_to(ROOT)}:{hit}" for path in files for hit in found(path)] == []


def blank(match: re.Match[str]) -> str:
    """As many spaces, so that places stay."""
    return " " * len(match[0])
