"""Block mode of a program that moves: a line and a move for each STEP."""

from tests.controller.hosts import Host, store

RUNNING, BLOCK_CONTROL, BLOCK_MODE, WAITING, FIRST = 1024, 1040, 1042, 1043, 1044
IN_MOTION, INHIBIT = 516, 540
MOVES = ("X1", "X2", "Y3", "INH -516", "SET 128")


def at(host: Host) -> tuple[float, float]:
    return host.card.axis(0).commanded_u, host.card.axis(1).commanded_u


def step(host: Host) -> tuple[float, float]:
    assert host.type("STEP") == "P00>"
    host.card.advance(1000)
    return at(host)


def test_each_step_lets_the_move_of_its_line_run_to_its_target(axes: Host) -> None:
    store(axes, *MOVES)
    axes.type("RUN", "BLK")
    axes.card.advance(100)
    assert [axes.card.bit[n] for n in (BLOCK_MODE, WAITING, FIRST)] == [True] * 3
    assert [step(axes) for _ in range(4)] == [(0, 0), (1, 0), (2, 0), (2, 3)]
    assert [axes.card.bit[n] for n in (BLOCK_MODE, WAITING, FIRST)] == [True, True, False]
    axes.type("AUT")
    axes.card.advance(200)
    assert not axes.card.bit[INHIBIT]
    assert axes.card.bit[128]


def test_the_first_step_ends_the_move_that_block_mode_has_stopped(axes: Host) -> None:
    store(axes, "X20", "X0", "Y3", "SET 128")
    axes.type("RUN")
    axes.card.advance(200)
    axes.type("BLK")
    axes.card.advance(1000)
    held = at(axes)
    assert 0 < held[0] < 20
    assert axes.card.bit[BLOCK_MODE]
    axes.card.advance(1000)
    assert at(axes) == held
    assert step(axes) == (20, 0), "the move after it waits for a step of its own"
    axes.card.advance(2000)
    assert at(axes) == (20, 0)
    assert step(axes) == (0, 0)
    assert step(axes) == (0, 3)


def test_aut_lets_everything_go_on_at_once(axes: Host) -> None:
    store(axes, "X20", "X0", "Y3", "SET 128")
    axes.type("RUN")
    axes.card.advance(200)
    axes.type("BLK")
    axes.card.advance(1000)
    axes.type("STEP", "AUT")
    axes.card.advance(4000)
    assert at(axes) == (0, 3)
    assert axes.card.bit[128]


def test_block_mode_chosen_before_run_stops_at_the_first_line(axes: Host) -> None:
    store(axes, "SET 130", "X1", "SET 131")
    axes.type("BLK")
    assert [axes.card.bit[n] for n in (BLOCK_CONTROL, BLOCK_MODE, WAITING, FIRST)] == [
        True, True, False, True,
    ]  # fmt: skip
    axes.type("RUN")
    axes.card.advance(2000)
    assert [axes.card.bit[n] for n in (RUNNING, BLOCK_MODE, WAITING, FIRST)] == [True] * 4
    assert (axes.card.bit[130], at(axes)) == (False, (0, 0))
    assert step(axes) == (0, 0), "the line PROGRAM"
    assert not axes.card.bit[FIRST]
    step(axes)
    assert (axes.card.bit[130], at(axes)) == (True, (0, 0))
    assert step(axes) == (1, 0)
    assert not axes.card.bit[131]


def test_block_mode_lasts_over_halt_and_run_until_aut(axes: Host) -> None:
    store(axes, *MOVES)
    axes.type("RUN", "BLK")
    axes.card.advance(100)
    step(axes)
    step(axes)
    axes.type("HALT", "RUN")
    axes.card.advance(4000)
    assert at(axes) == (1, 0), "stopped at the first line again"
    assert [axes.card.bit[n] for n in (BLOCK_CONTROL, BLOCK_MODE, WAITING)] == [True] * 3
    axes.type("HALT", "AUT", "RUN")
    assert [axes.card.bit[n] for n in (BLOCK_CONTROL, BLOCK_MODE, FIRST)] == [False] * 3
    axes.card.advance(4000)
    assert at(axes) == (2, 3)
    assert not axes.card.bit[IN_MOTION]
