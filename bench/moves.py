"""Binary moves streamed over TCP to a card in real time: is its buffer ever empty?"""

import time

from bench.figures import at_least
from bench.served import Line, served_card
from openacr.client import Card, MoveStream
from openacr.protocol.move import Move

MOVES, PER_S = 20000, 5000
WARM_UP = 1000
DEPTH = 400  # 80 ms: longer than a busy machine lets a host wait
COUNTS, UNIT = 10, 10000  # of one move; per unit


def _steps() -> list[Move]:
    """Moves of 1 / PER_S seconds each, one behind the other."""
    velocity = COUNTS * PER_S / UNIT
    return [Move.of({0: COUNTS * n}, vel=velocity) for n in range(1, MOVES + 1)]


def main() -> None:
    with served_card() as served:
        line = Line.to(served.ascii_port)
        for text in (
            "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', f"PPU X{UNIT}",
            f"DIM MBUF({DEPTH})", "MBUF ON", "ACC 0 DEC 0 STP 0", "DRIVE ON X",
        ):  # fmt: skip
            line.ask(text.encode() + b"\r")
        card = Card.open(f"127.0.0.1:{served.ascii_port}")
        stream = MoveStream(depth=DEPTH)
        moves = _steps()
        card.send_moves(moves[:WARM_UP], stream)
        first, began = card.moves_started(stream), time.perf_counter()
        card.send_moves(moves[WARM_UP:], stream)
        while (started := card.moves_started(stream)) < MOVES:
            time.sleep(0.001)
        rate = (started - first) / (time.perf_counter() - began)
        card.close()
    at_least("moves streamed and executed, made for 5 000/s", rate, 0.995 * PER_S, "1/s")


if __name__ == "__main__":
    main()
