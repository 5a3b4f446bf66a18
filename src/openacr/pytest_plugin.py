"""The pytest plugin `openacr`: cards as fixtures. Importing it costs next to nothing.

Everything heavy is in `openacr.testing` and is imported by the first test that asks for a card.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.testing.bench import Bench
    from openacr.testing.golden import Golden
    from openacr.testing.machine import Machine

BENCH = pytest.StashKey["Bench"]()
MACHINE = pytest.StashKey["Machine"]()
MARKER = "openacr(project, seconds): the project folder or controller file of the card of a test"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of a run, and the project of all tests."""
    group = parser.getgroup("openacr", "AcroBASIC programs on a virtual card")
    group.addoption("--openacr-update", action="store_true", help="Write golden traces anew.")
    group.addoption(
        "--openacr-cov", action="store_true", help="Report which lines of AcroBASIC were executed."
    )
    group.addoption(
        "--openacr-cov-html", metavar="FOLDER", help="The same as pages, a page for each file."
    )
    group.addoption("--openacr-cov-lcov", metavar="FILE", help="The same as an LCOV file.")
    group.addoption(
        "--openacr-pictures", metavar="FOLDER", help="Folder for pictures of tests that failed."
    )
    parser.addini("openacr_project", "Project folder or controller file of all tests.", default="")


def pytest_configure(config: pytest.Config) -> None:
    """Know the marker."""
    config.addinivalue_line("markers", MARKER)


def _bench(config: pytest.Config) -> Bench:
    if BENCH not in config.stash:
        from openacr.testing.bench import Bench

        options = ("--openacr-cov", "--openacr-cov-html", "--openacr-cov-lcov")
        config.stash[BENCH] = Bench(covers=any(map(config.getoption, options)))
    return config.stash[BENCH]


def _project(request: pytest.FixtureRequest) -> Path | None:
    """The project by parametrisation, marker or ini, in this order; None: a card without one."""
    config = request.config
    marker = request.node.get_closest_marker("openacr")
    named = getattr(request, "param", None)
    if named is None and marker is not None:
        named = marker.kwargs.get("project", marker.args[0] if marker.args else None)
        folder = Path(request.node.path).parent
    elif named is not None:
        folder = Path(request.node.path).parent
    else:
        named, folder = config.getini("openacr_project") or None, config.rootpath
    return None if named is None else folder / named


@pytest.fixture
def machine(request: pytest.FixtureRequest) -> Iterator[Machine]:
    """A card with its machine, as new: advance it, wait for conditions, read what it printed."""
    bench = _bench(request.config)
    module = request.node.nodeid.partition("::")[0]
    found = bench.machine(module, _project(request))
    request.node.stash[MACHINE] = found
    yield found
    bench.finish(found)


@pytest.fixture
def card(machine: Machine) -> Controller:
    """The `openacr.Controller` of the machine."""
    return machine.card


@pytest.fixture
def advance(machine: Machine) -> Callable[..., None]:
    """Let time pass on the card: `advance(seconds=1.5)`, `advance(ticks=3)`."""
    return machine.advance


@pytest.fixture
def until(machine: Machine) -> Callable[..., float]:
    """Let time pass until a condition holds: `until("BIT516 = 0", limit_s=5)`."""
    return machine.until


@pytest.fixture
def golden(request: pytest.FixtureRequest, machine: Machine) -> Golden:
    """Compare what the axes did with a file beside the test."""
    from openacr.testing.golden import Golden

    name = request.node.name.replace("/", "_")
    folder = Path(request.node.path).parent / "golden"
    return Golden(machine, folder / name, is_updated=request.config.getoption("--openacr-update"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[Any]) -> Any:
    """Add what the machine did last to the report of a test that failed."""
    report = yield
    found = item.stash.get(MACHINE, None)
    if found is not None and report.when == "call" and report.failed:
        from openacr.testing.pictures import last_moments

        named = item.config.getoption("--openacr-pictures")
        folder = Path(named) if named else None
        report.sections.append(
            ("openacr: the last moments", last_moments(found, folder, item.name))
        )
    return report


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Print the coverage, and write its files."""
    bench = config.stash.get(BENCH, None)
    if bench is None or bench.coverage is None:
        return
    from openacr.testing import coverage_report

    terminalreporter.section("coverage of AcroBASIC")
    for line in coverage_report.table(bench.coverage):
        terminalreporter.write_line(line)
    if folder := config.getoption("--openacr-cov-html"):
        coverage_report.write_html(bench.coverage, Path(folder))
    if file := config.getoption("--openacr-cov-lcov"):
        Path(file).write_text(coverage_report.lcov(bench.coverage), encoding="utf-8")
