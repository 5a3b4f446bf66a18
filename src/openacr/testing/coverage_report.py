"""Coverage of AcroBASIC and PLCs as a table, as pages and as an LCOV file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape
from pathlib import Path

from openacr.project import decode
from openacr.testing.coverage import Coverage
from openacr.testing.covered_lines import BRANCHES, Line

_STYLE = """
body { font-family: sans-serif; } pre { margin: 0; } td { padding: 0 .6em; }
.hit { background: #dfd; } .part { background: #ffd; } .miss { background: #fdd; }
"""


def table(coverage: Coverage) -> Iterator[str]:
    """A line for each file: lines, missing ones, branches, share; then what PLCs never did."""
    files = coverage.files()
    width = max(map(len, files), default=4)
    yield f"{'file':<{width}}  lines  missed  branches  missed  cover  missing"
    for file, lines in files.items():
        missed = [number for number, line in lines.items() if not line.count]
        branches = sum(len(line.branches) for line in lines.values())
        taken = sum(line.taken for line in lines.values())
        yield (
            f"{file:<{width}}  {len(lines):>5}  {len(missed):>6}  {branches:>8}"
            f"  {branches - taken:>6}  {share(lines.values()):>4.0f}%  {_ranges(missed)}"
        ).rstrip()
    for (file, number), line in sorted(coverage.lines.items()):
        for remark in line.remarks:
            yield f"{file}:{number}: {remark}"


def share(lines: Iterable[Line]) -> float:
    """Executed lines and taken branches, per cent of all."""
    found = list(lines)
    there = len(found) + sum(len(line.branches) for line in found)
    done = sum(line.count > 0 for line in found) + sum(line.taken for line in found)
    return 100.0 * done / there if there else 100.0


def _ranges(numbers: list[int]) -> str:
    return ", ".join(map(str, numbers))


def lcov(coverage: Coverage) -> str:
    """The format of `geninfo`, which services and editors read."""
    return "".join(_record(file, lines) for file, lines in coverage.files().items())


def _record(file: str, lines: dict[int, Line]) -> str:
    text = [f"SF:{file}"]
    branches = 0
    for number, line in lines.items():
        text.append(f"DA:{number},{line.count}")
        branches += len(line.branches)
        for place, times in enumerate(line.branches):
            block, branch = divmod(place, BRANCHES)
            text.append(f"BRDA:{number},{block},{branch},{'-' if times is None else times}")
    taken = sum(line.taken for line in lines.values())
    text += [f"BRF:{branches}", f"BRH:{taken}"]
    text += [f"LF:{len(lines)}", f"LH:{sum(line.count > 0 for line in lines.values())}"]
    return "\n".join([*text, "end_of_record", ""])


def write_html(coverage: Coverage, folder: Path) -> None:
    """A page for each file and one that lists them."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for number, (file, lines) in enumerate(coverage.files().items()):
        name = f"{number}_{Path(file).stem}.html"
        (folder / name).write_text(_page(file, lines), encoding="utf-8")
        link = f"<a href='{escape(name)}'>{escape(file)}</a>"
        rows.append(f"<tr><td>{link}</td><td>{share(lines.values()):.0f} %</td></tr>")
    body = f"<table>{''.join(rows)}</table>"
    (folder / "index.html").write_text(_document("Coverage of AcroBASIC", body), encoding="utf-8")


def _page(file: str, lines: dict[int, Line]) -> str:
    rows = []
    for number, text in enumerate(decode(Path(file).read_bytes()).splitlines(), start=1):
        line = lines.get(number)
        count = "" if line is None else str(line.count)
        taken = f"{line.taken}/{len(line.branches)}" if line is not None and line.branches else ""
        remarks = "" if line is None else "; ".join(line.remarks)
        cells = (
            f"<td>{number}</td><td>{count}</td><td>{taken}</td><td><pre>{escape(text)}</pre></td>"
            f"<td>{escape(remarks)}</td>"
        )
        rows.append(f"<tr class='{_class(line)}'>{cells}</tr>")
    return _document(file, f"<table>{''.join(rows)}</table>")


def _class(line: Line | None) -> str:
    if line is None:
        return ""
    if not line.count:
        return "miss"
    return "part" if line.taken < len(line.branches) else "hit"


def _document(title: str, body: str) -> str:
    return (
        "<!doctype html><html lang='en'><meta charset='utf-8'>"
        f"<title>{escape(title)}</title><style>{_STYLE}</style><h1>{escape(title)}</h1>{body}</html>\n"
    )
