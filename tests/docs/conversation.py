"""Pages that show commands and what they print: read as data, compared with what is printed."""

import re
import sys

OPENACR = (sys.executable, "-u", "-m", "openacr")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ANY = "..."


def conversations(page: str) -> list[tuple[str, list[str]]]:
    """Every command of the page with the lines that it shows of the output."""
    found: list[tuple[str, list[str]]] = []
    for language, text in BLOCK.findall(page):
        for line in text.splitlines() if not language else ():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def matches(shown: list[str], printed: str) -> bool:
    """Whether this was printed: `...` is any lines, at the end of a line any rest of it."""
    pattern = ""
    for line in shown:
        if line == ANY:
            pattern += r"(?:.*\n)*?"
        else:
            pattern += re.escape(line.rstrip()).replace(re.escape(ANY), ".*") + r" *\n"
    return re.fullmatch(pattern, printed) is not None
