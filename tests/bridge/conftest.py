"""Panels whose time passes by hand; libraries of other systems that leave sockets open."""

import gc
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.bridge.mqtt import RunningBroker, Subscriber
from tests.panel.bench import Served

HERE = Path(__file__).parent
LEAVING = ("test_epics", "test_opcua", "test_process", "test_sparkplug")
UNRAISABLE = "ignore::pytest.PytestUnraisableExceptionWarning"


def is_leaving(module: str) -> bool:
    """Whether the tests of a module use such libraries."""
    return module.rpartition(".")[2].startswith(LEAVING)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sockets and streams that libraries leave to the collector are no failure of a test."""
    for item in items:
        if item.path.parent == HERE and is_leaving(item.path.stem):
            item.add_marker(pytest.mark.filterwarnings(UNRAISABLE))


@pytest.fixture
def broker() -> Iterator[RunningBroker]:
    """A broker of MQTT."""
    with RunningBroker() as running:
        yield running


@pytest.fixture
def host(broker: RunningBroker) -> Iterator[Subscriber]:
    """A host application at the broker."""
    with Subscriber(broker.port) as subscriber:
        yield subscriber


@pytest.fixture
def quiet_panel(tmp_path: Path) -> Iterator[Served]:
    """A panel whose machine moves only in `step`."""
    served = Served(tmp_path, by_hand=True)
    yield served
    served.close()


@pytest.fixture(autouse=True)
def quick_node(monkeypatch: pytest.MonkeyPatch) -> None:
    """A Sparkplug node soon tries again to reach its broker."""
    monkeypatch.setattr("openacr.bridge.sparkplug.node.RETRY_S", (0.1, 0.5))


@pytest.fixture(scope="module", autouse=True)
def swept(request: pytest.FixtureRequest) -> Iterator[None]:
    """Collect what libraries leave open at the end of a file, before other tests are blamed."""
    yield
    if is_leaving(request.module.__name__):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ResourceWarning)
            gc.collect()
