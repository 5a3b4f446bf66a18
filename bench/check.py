"""Lines of a large program that `openacr check` reads per second, and that a card stores.

The programs repeat the statements of the examples with other numbers, labels and remarks in
every copy, so that hardly any line occurs twice.
"""

import random
import re
from pathlib import Path

from bench.cards import ROOT
from bench.figures import at_least, best_s, value_only
from openacr.controller import Controller
from openacr.controller.loading import Loader
from openacr.controller.streams import CONSOLE
from openacr.lang.shape import shape
from openacr.project import Place, Project, SourceFile
from openacr.source_check.source import Reader

LINES = 28_000
STORED = 12_000
AXES = "XYZAU"
SET_UP = (
    "SYS\nHALT ALL\nNEW ALL\nDETACH ALL\nCLEAR\n"
    + "".join(f"DIM PROG{number}(4000)\n" for number in range(1, 16))
    + "DIM PROG0(800000)\nDIM P(4000)\nDIM DEF(100)\n"
    + "".join(
        line + "\n"
        for file in sorted(ROOT.glob("examples/*/*.8k"))
        for line in file.read_text().splitlines()
        if line.upper().startswith("#DEFINE")
    )
    + "PROG0\nATTACH MASTER0\n"
    + "".join(f'ATTACH SLAVE{n} AXIS{n} "{name}"\n' for n, name in enumerate(AXES))
    + "DIM LV(100)\nDIM SV(100)\nDIM DV(100)\nDIM $V(100,80)\n"
    "DIM LA(1)\nDIM LA0(400)\n"
)
# Numbers of objects stay those of the card.
_NUMBER = re.compile(r"(?<![A-Za-z&#\d.])(?<!ENC )(?<!MASTER )\d+(?:\.\d+)?")
_NAME = re.compile(r"(?i)(^\s*_|GOTO\s+_?|GOSUB\s+_?)([A-Za-z]\w*)")
_WORDS = "axis camera drive fast home lift part safe slow table tool wait".split()
_BODY = re.compile(r"(?ims)^\s*PROGRAM\b(.*?)^\s*ENDP\b")


def program(count: int) -> str:
    """A program of about that many lines."""
    chance = random.Random(5)
    files = sorted(Path(ROOT, "examples").glob("*/prog*.8k"))
    pattern = [line for file in files for line in _body(file.read_text()) if line.strip()]
    lines = ["PROGRAM"]
    copy = 0
    while len(lines) < count:
        copy += 1
        lines += [_varied(line, copy, chance) for line in pattern]
    return "\n".join([*lines, "ENDP", ""])


def _body(text: str) -> list[str]:
    """The lines between PROGRAM and ENDP."""
    found = _BODY.search(text)
    return found[1].splitlines() if found else []


def _varied(line: str, copy: int, chance: random.Random) -> str:
    """The line with other numbers, other names and another remark."""
    code, rem, _ = line.partition("REM")
    code = _NAME.sub(lambda found: f"{found[1]}{found[2]}c{copy}", code)
    parts = code.split('"')
    parts[::2] = [_NUMBER.sub(lambda found: _number(found[0], chance), part) for part in parts[::2]]
    remark = f"REM {' '.join(chance.sample(_WORDS, 4))} {chance.randrange(1000)}" if rem else ""
    return '"'.join(parts) + remark


def _number(text: str, chance: random.Random) -> str:
    return f"{chance.uniform(0, 99):.3f}" if "." in text else str(chance.randrange(1, 99))


def main() -> None:
    setup = SourceFile(Path("setup.8k"), SET_UP.encode())
    source = SourceFile(Path("prog0.8k"), program(LINES).encode(), Place.PROGRAM)
    lines = source.text.splitlines()

    def check() -> None:
        reader = Reader()
        reader.read(setup)
        reader.read(source)
        if errors := [fault for fault in reader.faults if not fault.is_warning]:
            raise RuntimeError(f"{errors[0]}")

    per_s = len(lines) / best_s(check, 3)
    at_least("lines checked per second", per_s, 200_000, "1/s")
    value_only("  different lines in a hundred", 100 * len(set(lines)) / len(lines), "%")
    value_only("  shapes of lines among them", len(set(map(shape, lines))), "")
    _store(setup, program(STORED))


def _store(setup: SourceFile, text: str) -> None:
    card = Controller()
    session = card.system.sessions[CONSOLE]
    loader = Loader(card.system, session, lambda: False)
    stored = SourceFile(Path("prog0.8k"), text.encode(), Place.PROGRAM)
    if errors := loader.load(Project(Path(), setup)):
        raise errors[0]

    def load() -> None:
        if errors := loader.load(Project(Path(), None, (stored,))):
            raise errors[0]

    per_s = text.count("\n") / best_s(load, 3)
    at_least("lines stored in a card per second", per_s, 50_000, "1/s")


if __name__ == "__main__":
    main()
