"""Part programs with turns in planned paths: started at a line, checked, drawn, sent in pieces."""

import math
from pathlib import Path

import numpy as np
import pytest
from tests.mill.live import Plant
from tests.mill.planned import FEED, JERK, SPEED, TOLERANCE, Reals
from tests.mill.planned_rotary import (
    CELLS,
    SCALES,
    TURN_ACCEL,
    TURN_SPEED,
    A,
    assert_limits,
    follow,
    line,
    off_path,
    rotary_shop,
    table_store,
    to,
)
from tests.mill.sender import Sender
from tests.mill.shop import src
from tests.mill.test_planned_lost_host import cells
from tests.waiting import until

from openacr.cnc import canonical as c
from openacr.cnc.loading.load import load
from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map.rows import axes
from openacr.mill.config.communications import Line
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import ACCELERATION_SHARE, JERK_SHARE
from openacr.mill.plan.estimate.checking import Watchers, checked, surveyed
from openacr.mill.plan.estimate.predicting import Prediction
from openacr.mill.plan.pictures.path_motion import PathMotion
from openacr.mill.plan.pictures.quantities import Quantity
from openacr.mill.run.dripping import Drip
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import COMMUNICATIONS, CONTROL, SPEEDS

HEAD = f"G64 P{TOLERANCE}\nF{FEED}\n"
WAVE = [(k / 2, 2 * math.sin(k / 10), 20 * math.sin(k / 20)) for k in range(1, 80)]
BLOCKS = [f"G1 X{x:.4f} Y{y:.4f} A{a:.4f}\n" for x, y, a in WAVE]
MOVES = [line(k, round(x, 4), round(y, 4), 0.0, round(a, 4)) for k, (x, y, a) in enumerate(WAVE)]
END_CNT = [round(value * scale) for value, scale in zip(MOVES[-1].end, SCALES, strict=False)]
TICK_S = 0.0005
TANGENTIAL = {
    f"P{CONTROL.tangential_axis}": A, f"P{CONTROL.perpen_tangent_epsilon}": 5.0,
    f"P{SPEEDS.path_tolerance}": TOLERANCE,
}  # fmt: skip
SETPOINTS = [Sample(Watched.FP64, axes.psp_cnt[axis]) for axis in range(A + 1)]


def run(store: Store, text: str, dialect: str = "rs274ngc", line: int = 1) -> Reals:
    """Where X Y Z A are commanded to on the virtual machine, tick by tick."""
    session = MillSession.virtual(store, lambda _text: None)
    card = session.virtual_card
    assert card is not None
    card.record(samples=SETPOINTS)
    program = load(text.encode(), store, dialect)
    assert program.errors == []
    session.start(program, Start(dialect=dialect, line=line, is_repeated=False))
    while session.runner.is_busy:
        session.step()
    assert session.runner.state is State.IDLE
    found: Reals = card.trace().values / SCALES
    return found


@pytest.mark.parametrize("at", [2, 40])
def test_a_program_starts_at_a_line_with_the_table_turned(at: int) -> None:
    head = HEAD + "G0 Z5\nG1 Z0\n"
    places = run(table_store(), head + "".join(BLOCKS) + "M2\n", line=head.count("\n") + at)
    before = MOVES[at - 2].end[: A + 1]
    begin = int(np.flatnonzero((np.abs(places - before) * SCALES <= 0.51).all(axis=1))[0])
    assert places[:begin, 2].max() == 5.0
    assert_limits(places[begin:], TICK_S)
    assert (places[-1] * SCALES).tolist() == END_CNT
    off = off_path(table_store(), places[begin:], MOVES[at - 1 :], MOVES[at - 2].end)
    assert off <= TOLERANCE


# --- the tangential axis --------------------------------------------------------------------

ROUND = c.Arc(
    src(2), to(20, 10, 0, 90), c.Plane.XY, (10.0, 10.0), math.pi / 2, 10.0, 10.0, c.Pace(FEED)
)


def test_a_tangential_axis_turns_with_arcs_and_at_rest_in_corners() -> None:
    store = table_store(**TANGENTIAL)
    places = run(
        store, f"G71\nM595\nF{FEED}\nG1 X10\nG3 X20 Y10 I10 J10\nG1 Y20\nX0\nM2\n", "acromill"
    )
    path: list[c.Entry] = [
        line(1, 10),
        ROUND,
        line(3, 20, 20, 0, 90),
        line(4, 20, 20, 0, 180),
        line(5, 0, 20, 0, 180),
    ]
    assert_limits(places, TICK_S)
    assert off_path(store, places, path) <= TOLERANCE
    turning = (places[:, A] > 90.0) & (places[:, A] < 180.0)
    assert (places[turning][:, :2] == (20.0, 20.0)).all()
    assert (places[-1] * SCALES).tolist() == [0, 200_000, 0, 1_800_000]


def test_a_tangential_axis_follows_chords_without_a_stop() -> None:
    bends = [math.radians(angle) for angle in range(3, 91, 3)]
    corners = [(10.0, 0.0)] + [(10 + 20 * math.sin(t), 20 - 20 * math.cos(t)) for t in bends]
    corners = [(round(x, 5), round(y, 5)) for x, y in [*corners, (30.0, 40.0)]]
    steps = zip([(0.0, 0.0), *corners], corners, strict=False)
    turns = [math.degrees(math.atan2(q - b, p - a)) for (a, b), (p, q) in steps]
    path = [
        line(k, x, y, 0, turn) for k, ((x, y), turn) in enumerate(zip(corners, turns, strict=True))
    ]
    store = table_store(**TANGENTIAL)
    text = "".join(f"G1 X{x:.5f} Y{y:.5f}\n" for x, y in corners)
    places = run(store, f"G71\nM595\nF{FEED}\n{text}M2\n", "acromill")
    assert_limits(places, TICK_S)
    assert off_path(store, places, path) <= TOLERANCE
    moving = np.flatnonzero(np.diff(places, axis=0).any(axis=1))
    assert (np.diff(moving) == 1).all()
    assert (places[-1] * SCALES).tolist() == [300_000, 400_000, 0, 900_000]


# --- what is known before a run -------------------------------------------------------------


def found_in(text: str) -> tuple[list[str], Prediction]:
    """The findings of `mill check` with their hints, and the prediction."""
    store = table_store()
    program = load((HEAD + text + "M2\n").encode(), store, "rs274ngc")
    assert program.errors == []
    survey, prediction = checked(program, store, "rs274ngc")
    return [f"{finding.code} {finding.hint}" for finding in survey.findings], prediction


def ramped_s(length: float, speed: float, accel: float) -> float:
    """A move from rest to rest with an S-curve that reaches speed and acceleration, as planned."""
    most, jerk = ACCELERATION_SHARE * accel, JERK_SHARE * JERK
    exact_s = length / speed + speed / most + most / jerk
    return (math.ceil(exact_s / PERIOD_S) + 2) * PERIOD_S


def test_a_turn_takes_the_time_of_an_s_curve_and_its_loss_is_that_of_its_ramps() -> None:
    findings, prediction = found_in(f"G1 A90 F{60 * TURN_SPEED}\n")
    assert findings == []
    assert prediction.time_s == pytest.approx(ramped_s(90.0, TURN_SPEED, TURN_ACCEL), abs=1e-9)
    settling_s = 2 * PERIOD_S  # of three equal points at rest
    assert prediction.lost_s == pytest.approx(prediction.time_s - settling_s - 1.0, abs=1e-9)
    assert (prediction.planned, prediction.slowest_line) == (1, 3)


def test_the_limit_of_the_table_is_the_feed_that_check_reports() -> None:
    findings, _ = found_in("G1 X20 A90\nX40 Y10 A0\n")
    share = math.hypot(20.0, 10.0) / SPEED
    assert findings == [f"W402 line 3 reaches {100 * share:.3g} % of F"]


@pytest.mark.parametrize(
    ("text", "highest"),
    [
        ("G1 X10 A50 F600\n", (600.0, TURN_ACCEL / 5, JERK / 5)),  # 5 degrees per mm
        ("G1 A90\n", (0.0, 0.0, 0.0)),
    ],
)
def test_pictures_show_the_motion_of_the_tool_with_the_limits_of_the_table(
    text: str, highest: tuple[float, ...]
) -> None:
    store = table_store()
    program = load((HEAD + text + "M2\n").encode(), store, "rs274ngc")
    shares = (1.0, ACCELERATION_SHARE, JERK_SHARE)
    for quantity, most, share in zip(Quantity, highest, shares, strict=True):
        reader = PathMotion(Settings(store), (0, 1, 2), quantity)
        surveyed(program, store, "rs274ngc", Watchers(reader))
        motion = reader.finished()
        assert motion.highest == pytest.approx(share * most, rel=2e-3)
        assert motion.highest <= share * most * (1 + 1e-9)
        assert motion.known.all()


# --- senders and links ----------------------------------------------------------------------


def test_turns_that_arrive_slowly_rest_on_the_path_and_go_on(sender: Sender) -> None:
    shop = rotary_shop(
        **{f"P{SPEEDS.path_tolerance}": TOLERANCE, f"P{CONTROL.dripfeed_threshold}": 20.0}
    )
    shop.store.write_text(COMMUNICATIONS.port, sender.port)
    drip = Drip(Line.of(shop.store), shop.store)
    shop.runner.run(drip.entries)
    sender.send(f"G90 F{FEED}\n" + "".join(BLOCKS[:40]))
    places = follow(shop, (2.0, lambda _shop: sender.send("".join(BLOCKS[40:]) + "M2\n")))
    drip.close()
    assert_limits(places, TICK_S)
    starved = places[round(1.9 / TICK_S) : round(2.0 / TICK_S)]
    assert (starved == starved[0]).all()
    assert 10.0 < starved[0][0] < 20.0  # on the path of the blocks that have arrived
    assert (places[-1] * SCALES).tolist() == END_CNT
    assert off_path(shop.store, places, MOVES) <= TOLERANCE


def test_turns_run_over_a_link_to_the_last_count_of_the_encoders(tmp_path: Path) -> None:
    plant = Plant(tmp_path, is_journalled=True)
    try:
        plant.wire(cells() | CELLS | {CONTROL.link_timeout: 60.0})
        part = plant.part(HEAD + "".join(BLOCKS) + "M2\n")
        run = plant.mill("run", part, "--dialect", "rs274ngc", "--quiet")
        assert run.ended() == 0, run.text
        encoders = list(axes.actual_position[: A + 1])
        until(lambda: plant.card.read_many(encoders) == END_CNT)
        places = plant.lived_again(*SETPOINTS).values / SCALES
        assert_limits(places, TICK_S)
        assert (places[-1] * SCALES).tolist() == END_CNT
    finally:
        plant.close()
