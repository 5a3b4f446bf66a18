"""Panels for tests: a station driven by hand, a server in real time, a server driven by hand."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.panel.bench import HandStation, Served, card_of

from openacr.client import Card
from openacr.controller import Controller
from openacr.panel.control.machine.installation import Installation
from openacr.panel.machine import opened
from openacr.panel.machine.project import of_project

GANTRY = Path(__file__).parents[2] / "examples" / "gantry"


@pytest.fixture
def hand(tmp_path: Path) -> Iterator[HandStation]:
    """A station with the virtual mill; time passes only when the test lets it."""
    station = HandStation(tmp_path)
    yield station
    station.close()


@pytest.fixture
def panel(tmp_path: Path) -> Iterator[Served]:
    """A server with the virtual mill in real time, the sample part loaded."""
    served = Served(tmp_path)
    yield served
    served.close()


@pytest.fixture
def quiet_panel(tmp_path: Path) -> Iterator[Served]:
    """A server whose machine moves only in `step`."""
    served = Served(tmp_path, by_hand=True)
    yield served
    served.close()


@pytest.fixture(scope="module")
def one_panel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server in real time for all tests of a file."""
    served = Served(tmp_path_factory.mktemp("panel"))
    yield served
    served.close()


@pytest.fixture
def kept_panel(one_panel: Served) -> Iterator[Served]:
    """The server of the file, for tests that move nothing; what they store is put back."""
    with one_panel.as_it_was():
        yield one_panel


@pytest.fixture(scope="module")
def one_quiet_panel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server whose machine moves only in `step`, for all tests of a file."""
    served = Served(tmp_path_factory.mktemp("panel"), by_hand=True)
    yield served
    served.close()


@pytest.fixture
def kept_quiet_panel(one_quiet_panel: Served) -> Iterator[Served]:
    """As `kept_panel`, where time does not pass by itself."""
    with one_quiet_panel.as_it_was():
        yield one_quiet_panel


@pytest.fixture(params=["set up", "as it is"])
def gantry(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[HandStation]:
    """The gantry with the drive of Z on, by its own store and by one that does not know it."""
    if request.param == "set up":
        installation = of_project(
            shutil.copytree(GANTRY, tmp_path / "gantry"),
            store=None,
            programs=None,
            otherwise=tmp_path / "parts",
        )
    else:
        (tmp_path / "programs").mkdir()
        card = Controller.from_project(GANTRY)
        installation = Installation.inside(
            card, opened(tmp_path / "sysvar.db"), tmp_path / "programs"
        )
        installation.is_agreed = False
    hand = HandStation(tmp_path, installation=installation)
    with Card.open(card_of(hand)) as there:
        for line in ("DRIVE ON", "JOG ACC 100", "JOG DEC 100"):
            there.command(f"AXIS2 {line}")
    hand.run(0.1)
    yield hand
    hand.close()
