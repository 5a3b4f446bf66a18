"""Block mode of a program that moves: a line and a move for each STEP."""

from tests.controller.hosts import Host, store

BLOCK_MODE, WAITING, FIRST = 1042, 1043, 1044
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
    assert step(axes) == (20, 0), "the move behind it waits for a step of its own"
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


def test_a_run_behind_a_stepped_program_moves_as_ever(axes: Host) -> None:
    store(axes, *MOVES)
    axes.type("RUN", "BLK")
    axes.card.advance(100)
    step(axes)
    step(axes)
    axes.type("HALT", "RUN")
    axes.card.advance(4000)
    assert at(axes) == (2, 3)
    assert not axes.card.bit[IN_MOTION]
