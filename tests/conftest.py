"""What all tests need."""

import gc
import importlib
import os
import signal
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import settings
from tests import longest, warm

TESTS = Path(__file__).parent
# How long an example takes depends on who else computes; pytest-timeout ends what hangs.
settings.register_profile("patient", deadline=None)
settings.load_profile("patient")


# A shell lets what it starts in the background ignore Ctrl-C, nohup lets it ignore the end of its
# terminal, and all processes of tests with it.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.fixture(scope="session", autouse=True)
def _journals(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Journals of cards that tests serve stay out of the folders of the user."""
    os.environ["OPENACR_JOURNALS"] = str(tmp_path_factory.mktemp("journals"))


@pytest.fixture(scope="session", autouse=True)
def _workers() -> None:
    """Processes of pools begin warm."""
    warm.fork_workers()


@pytest.hookimpl(wrapper=True)
def pytest_collection(session: pytest.Session) -> Iterator[None]:
    """Twenty thousand tests are no garbage: it is not looked for while they are made, nor later."""
    gc.disable()
    try:
        _import_another_part_first(session.config)
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def _import_another_part_first(config: pytest.Config) -> None:
    """In each worker: what has never been compiled is then compiled once, not in each of them."""
    worker = getattr(config, "workerinput", None)
    if worker is None or config.args_source is not config.ArgsSource.TESTPATHS:
        return
    paths = sorted(TESTS.rglob("test_*.py"))
    first = len(paths) * int(worker["workerid"].removeprefix("gw")) // worker["workercount"]
    for path in paths[first:] + paths[:first]:
        with suppress(Exception, pytest.skip.Exception):  # which its collection shows
            importlib.import_module(".".join(path.relative_to(TESTS.parent).with_suffix("").parts))


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Files that take longest begin first."""
    longest.sort(items, longest.noted(getattr(config, "cache", None)))


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    """Note what each file took, for the next run."""
    cache = getattr(config, "cache", None)
    reports = [each for kind in terminalreporter.stats.values() for each in kind]
    tests = (each for each in reports if isinstance(each, pytest.TestReport))
    if cache is not None:
        cache.set(longest.KEY, longest.noted(cache) | longest.measured(tests))
