"""Texts of messages: counts with their nouns, words as a shell takes them."""

import os
import shlex
import subprocess

WINDOWS = os.name == "nt"


def counted(cnt: int, noun: str) -> str:
    """A count with its noun: `1 error`, `2 errors`, `1 entry`, `2 entries`."""
    if cnt == 1:
        return f"1 {noun}"
    ends_in_y = noun.endswith("y") and noun[-2:-1] not in "aeiou"
    return f"{cnt} {noun[:-1]}ies" if ends_in_y else f"{cnt} {noun}s"


def as_typed(word: object) -> str:
    """A path or name as it is typed at a prompt: in quotes where it has spaces."""
    return subprocess.list2cmdline([str(word)]) if WINDOWS else shlex.quote(str(word))
