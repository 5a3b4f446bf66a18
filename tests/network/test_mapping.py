"""Digital points of nodes at the flags of the expansion boards, where PLCs reach them."""

import pytest
from tests.network.rig import DI, DO, card, expect, node, output, start

from openacr.controller import Controller

WIDE = {"digital_inputs": 128, "digital_outputs": 128, "bit_rate": 1000}
WORLD = "".join(node(11 + n, **WIDE) for n in range(4))
# Node and word at each pair of expansion words.
TABLE = {
    1: [(0, 0), (0, 1), (0, 2), (0, 3)],
    2: [(0, 0), (0, 1), (1, 0), (1, 1)],
    3: [(0, 0), (1, 0), (2, 0), (3, 0)],
}


def mapped(mapping: int) -> Controller:
    """A card with four nodes of 128 points and this P32771."""
    made = card(WORLD)
    expect(made, 11, 12, 13, 14, bit_rate=1000)
    made.p[32771] = mapping
    assert start(made) == 2
    return made


@pytest.mark.req("ACR-CAN-02", "ACR-CAN-03", "ACR-CAN-04", "ACR-CAN-06")
@pytest.mark.parametrize(
    ("mapping", "table"), [(1, TABLE[1]), (2, TABLE[2]), (3, TABLE[3]), (7, TABLE[3])]
)
def test_the_first_words_of_nodes_move(mapping: int, table: list[tuple[int, int]]) -> None:
    made = mapped(mapping)
    for pair, (slave, word) in enumerate(table):
        terminal = 32 * word + pair
        made.set_input(DI[slave] + terminal, True)
        made.bit[32 * (9 + 2 * pair) + pair] = True
        made.advance(seconds=0.06)
        assert made.p[4104 + 2 * pair] == 1 << pair
        assert output(made, slave, terminal)
        assert made.p[4456 + 32 * slave + word] == 0
        assert made.p[4472 + 32 * slave + word] == 0


@pytest.mark.req("ACR-CAN-06")
def test_a_moved_output_is_controlled_by_one_flag_alone() -> None:
    made = mapped(1)
    made.bit[DO[0]] = True
    made.advance(seconds=0.06)
    assert not output(made, 0, 0)
    made.bit[288] = True
    made.advance(seconds=0.06)
    assert output(made, 0, 0)


@pytest.mark.req("ACR-CAN-07")
def test_the_mapping_changes_with_the_next_start() -> None:
    made = mapped(0)
    made.set_input(DI[0], True)
    made.p[32771] = 1
    made.advance(seconds=0.06)
    made.set_input(DI[0] + 1, True)
    made.advance(seconds=0.06)
    assert (made.p[4456], made.p[4104]) == (3, 0)
    assert start(made) == 2
    assert (made.p[4456], made.p[4104]) == (0, 3)
    made.p[32771] = 0
    made.set_input(DI[0], False)
    made.advance(seconds=0.06)
    assert (made.p[4456], made.p[4104]) == (0, 2)
    assert start(made) == 2
    assert made.p[4456] == 2
