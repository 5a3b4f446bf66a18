"""A card that loses its host within a planned path: it comes to rest on it, within the limits."""

import math
from collections.abc import Iterator

import pytest
from tests.mill.planned import (
    ACCEL,
    FEED,
    JERK,
    SPEED,
    SQUARE,
    TOLERANCE,
    Reals,
    highest,
    off_path,
    wave,
)

from openacr.cnc.loading.load import load
from openacr.cnc.occupied import HOLD_AT, RAN_SHORT
from openacr.controller import Controller
from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map.rows import axes
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import SPEEDS

Point = tuple[float, ...]
PULSES = 10_000.0
HOME_REQUIRED, LINK_TIMEOUT = 200_007, 250_126
PATIENT_S = 30.0  # the heartbeat is one of real time
ROUNDING = 0.03  # of the jerk: positions of 24 bits over the cube of 4 ms
TICKS = 20
PATHS: dict[str, list[Point]] = {
    "square": [*SQUARE],
    "wave": wave(400),
    "corners": [(9.0 * k, 5.0 * (k % 2)) for k in range(1, 10)],
}


def cells() -> dict[int, float]:
    """The cells of a machine with a jerk limit; nothing has to be homed."""
    homed = {HOME_REQUIRED + 1000 * axis: 0.0 for axis in range(3)}
    return homed | {
        SPEEDS.path_jerk: JERK,
        SPEEDS.master_feed_acc_dec: ACCEL,
        SPEEDS.master_rapid_acc_dec: ACCEL,
        SPEEDS.max_machine_speed: FEED,
    }


def text_of(points: list[Point], feed: float = FEED) -> str:
    """A path with a tolerance as a program."""
    blocks = "\n".join(f"X{p[0]:.6f} Y{p[1]:.6f} Z{(*p, 0.0)[2]:.6f}" for p in points)
    return f"G64 P{TOLERANCE}\nF{feed}\nG1\n{blocks}\nM2\n"


class Host:
    """A host that drives a card over a link, here without one, and can be silent."""

    def __init__(
        self,
        points: list[Point],
        feed: float = FEED,
        card: Controller | None = None,
        own: dict[int, float] | None = None,
    ) -> None:
        self.card = card or Controller()
        self.said: list[str] = []
        store = Store()
        for cell, value in (cells() | {LINK_TIMEOUT: PATIENT_S} | (own or {})).items():
            store.write(cell, value)
        self.session = MillSession.real(self.card, store, self.said.append)
        self.session.card.command("DRIVE ON X Y Z", program=0)
        program = load(text_of(points, feed).encode(), store, "rs274ngc")
        self.session.start(program, Start(dialect="rs274ngc", is_repeated=False))
        rows = [axes.psp_cnt[axis] for axis in range(3)]
        self.card.record(samples=[Sample(Watched.FP64, row) for row in rows])

    def live(self, seconds: float) -> None:
        """Poll the card as a host does."""
        for _ in range(round(seconds / self.card.period_s / TICKS)):
            self.silent(TICKS * self.card.period_s)
            self.session.poll()

    def finish(self, limit_s: float = 15.0) -> None:
        """Poll to the end of the program."""
        end_s = self.card.time_s + limit_s
        while self.session.runner.is_busy and self.card.time_s < end_s:
            self.live(TICKS * self.card.period_s)

    def silent(self, seconds: float) -> None:
        """Let the card run alone."""
        self.card.advance(seconds=seconds)

    @property
    def places(self) -> Reals:
        """Where the axes are commanded to, tick by tick."""
        return self.card.trace().values / PULSES

    def require_limits(self, points: list[Point], tolerance: float = TOLERANCE) -> None:
        places = self.places
        speed, accel, jerk = highest(places, self.card.period_s)
        assert speed <= SPEED * (1 + 1e-4)
        assert accel <= ACCEL * (1 + 1e-4)
        assert jerk <= JERK * (1 + ROUNDING)
        assert off_path(places, points) <= tolerance

    @property
    def speed(self) -> float:
        last, before = self.places[-1], self.places[-2]
        return math.dist(last, before) / self.card.period_s


@pytest.fixture(params=list(PATHS))
def points(request: pytest.FixtureRequest) -> Iterator[list[Point]]:
    yield PATHS[request.param]


@pytest.mark.parametrize("after_s", [0.15, 0.31, 0.47, 0.62, 0.78])
def test_the_card_rests_on_the_path_without_its_host(points: list[Point], after_s: float) -> None:
    host = Host(points)
    host.live(after_s)
    assert host.speed > 0.0
    host.silent(1.0)
    assert host.speed == 0.0
    assert host.card.bit[RAN_SHORT]
    assert host.card.bit[n_of_hold()]
    assert math.dist(host.places[-1], (*points[-1], 0.0)[:3]) > 1.0
    host.require_limits(points)


def n_of_hold() -> int:
    return 519  # In Feedhold of master 0


def test_a_host_that_was_late_goes_on_from_where_the_card_rests() -> None:
    points = PATHS["wave"]
    host = Host(points)
    host.live(0.4)
    host.silent(0.9)
    rested = host.places[-1]
    host.finish()
    assert host.session.runner.state is State.IDLE
    assert host.places[-1] == pytest.approx(points[-1], abs=0.5 / PULSES)
    assert math.dist(rested, host.places[-1]) > 1.0
    host.require_limits(points, 2 * TOLERANCE)
    assert host.said[-1:] == [
        "the card had too little of the path and rests on it; it goes on from there"
    ]


def test_a_host_that_is_a_little_late_is_not_noticed(points: list[Point]) -> None:
    host = Host(points)
    for _ in range(40):
        host.live(0.03)
        host.silent(0.06)
    host.finish()
    assert host.session.runner.state is State.IDLE
    assert host.said == []
    host.require_limits(points)


def test_a_host_that_is_late_again_and_again_has_sent_more_ahead(points: list[Point]) -> None:
    host = Host(points)
    for _ in range(40):
        host.live(0.02)
        host.silent(0.12)
    host.finish()
    assert host.session.runner.state is State.IDLE
    assert len(host.said) == 1  # the first time, when it was not known
    host.require_limits(points, 3 * TOLERANCE)  # it went on from beside chords


def test_the_end_of_a_path_is_no_lack_of_it(points: list[Point]) -> None:
    host = Host(points)
    host.finish()
    assert (host.session.runner.state, host.said) == (State.IDLE, [])
    assert host.card.p[HOLD_AT] == 0
    assert host.places[-1] == pytest.approx([*(*points[-1], 0.0)[:3]], abs=0.5 / PULSES)
    host.require_limits(points)
