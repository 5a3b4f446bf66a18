"""Verdicts as JUnit XML, which services of continuous integration show as tests."""

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as Xml

from openacr.lang.characters import shown
from openacr.verify.checking import Status, Verdict

FAILURES = (Status.ERRORS, Status.TOO_LONG)


def junit(verdicts: Sequence[Verdict], folder: Path) -> bytes:
    """A suite of a folder: a case for each program, a failure for one with errors.

    A program that could not be read, or whose check has died, is an error. The time of a case is
    the machine time of its program.
    """
    failed = [verdict for verdict in verdicts if verdict.status in FAILURES]
    counts = {
        "tests": len(verdicts),
        "failures": len(failed),
        "errors": sum(not verdict.is_good for verdict in verdicts) - len(failed),
        "skipped": 0,
    }
    numbers = {name: str(count) for name, count in counts.items()}
    root = Xml.Element("testsuites", {"name": "openacr verify", **numbers})
    suite = Xml.SubElement(root, "testsuite", {"name": _text(str(folder)), **numbers})
    for verdict in verdicts:
        suite.append(_case(verdict, folder))
    Xml.indent(root)
    data: bytes = Xml.tostring(root, encoding="utf-8", xml_declaration=True)
    return data + b"\n"


def _case(verdict: Verdict, folder: Path) -> Xml.Element:
    place = verdict.file.relative_to(folder)
    names = {
        "name": _text(place.name),
        "classname": _text(".".join(place.parent.parts) or "programs"),
    }
    if verdict.time_s is not None:
        names["time"] = f"{verdict.time_s:.3f}"
    case = Xml.Element("testcase", names)
    if not verdict.is_good:
        kind = "failure" if verdict.status in FAILURES else "error"
        first = verdict.reason or verdict.errors[0].text
        about = {"type": str(verdict.status), "message": _text(first)}
        found = Xml.SubElement(case, kind, about)
        found.text = _text("\n".join(map(str, verdict.errors)) or verdict.reason)
    if verdict.warnings:
        output = Xml.SubElement(case, "system-out")
        output.text = _text("\n".join(map(str, verdict.warnings)))
    return case


def _text(text: str) -> str:
    """A text without what XML cannot hold."""
    lines = (shown(line) for line in text.encode("utf-8", "replace").decode().split("\n"))
    return "\n".join(lines)
