"""JUnit XML of every kind of verdict: counts, kinds and times, exactly."""

from pathlib import Path
from xml.etree import ElementTree as Xml

from openacr.verify.checking import Note, Status, Verdict
from openacr.verify.junit import junit

SHOP = Path("shop")
FIRST = Note(True, "E105", "value expected", "shop/b.nc", 3, 2)
SECOND = Note(True, "E200", "no such axis", "shop/b.nc", 4)
DOUBT = Note(False, "W405", "nothing is wired", "shop/b.nc", 2)
VERDICTS = [
    Verdict(SHOP / "a.nc", Status.OK, time_s=1.23456),
    Verdict(SHOP / "b.nc", Status.ERRORS, (DOUBT, FIRST, SECOND)),
    Verdict(SHOP / "jobs" / "old" / "c.nc", Status.WARNINGS, (DOUBT,), time_s=0.0),
    Verdict(SHOP / "d.nc", Status.TOO_LONG, reason="it takes more than 600 s"),
    Verdict(SHOP / "e.nc", Status.UNREADABLE, reason="no such file"),
    Verdict(SHOP / "f.nc", Status.LOST, reason="the worker process died"),
    Verdict(SHOP / "g.nc", Status.UNREADABLE, reason="no such file"),
]


def test_each_verdict_is_counted_once_as_what_it_is() -> None:
    data = junit(VERDICTS, SHOP)
    assert data.startswith(b"<?xml version='1.0' encoding='utf-8'?>\n")
    root = Xml.fromstring(data)
    counts = {"tests": "7", "failures": "2", "errors": "3", "skipped": "0"}
    assert root.attrib == {"name": "openacr verify", **counts}
    assert root[0].attrib == {"name": "shop", **counts}
    kinds = [[(each.tag, each.get("type")) for each in case] for case in root[0]]
    assert kinds == [
        [],
        [("failure", "errors"), ("system-out", None)],
        [("system-out", None)],
        [("failure", "too long")],
        [("error", "unreadable")],
        [("error", "lost")],
        [("error", "unreadable")],
    ]


def test_a_case_has_its_folder_its_time_and_all_its_errors() -> None:
    cases = list(Xml.fromstring(junit(VERDICTS, SHOP))[0])
    assert [case.get("time") for case in cases] == ["1.235", None, "0.000", *[None] * 4]
    assert [case.get("classname") for case in cases[:3]] == ["programs", "programs", "jobs.old"]
    failure, output = cases[1]
    assert failure.get("message") == "value expected"
    assert failure.text == f"{FIRST}\n{SECOND}"
    assert output.text == str(DOUBT)
    assert (cases[3][0].get("message"), cases[3][0].text) == ("it takes more than 600 s",) * 2
