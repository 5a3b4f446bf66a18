"""Lines that a host sends in one write: what each costs must not depend on how many follow it."""

from bench.figures import at_most, best_s
from openacr.channels import StreamKind
from openacr.controller import Controller

FEW, MANY = 500, 8000
TARGET_MS, TARGET_RATIO = 0.6, 1.3


def _entered(lines: int) -> None:
    """Numbered lines of a program in pieces as sockets are read, until the last is answered."""
    card = Controller()
    card.is_journalled = False
    card.send("DIM PROG0(400000)\rPROG0\r")
    stream = card.open_stream(StreamKind.TERMINAL)
    text = b"PROG0\rNEW\r" + b"".join(b"%d REM line %d\r" % (n, n) for n in range(1, lines + 1))
    at, answered = 0, 0
    while answered < lines + 2:
        if at < len(text) and card.accepts_input(stream):
            card.receive(stream, text[at : at + 1024])
            at += 1024
        card.advance(1)
        while data := card.take_output(stream):
            answered += data.count(b">")


def main() -> None:
    few_s = best_s(lambda: _entered(FEW), 3) / FEW
    many_s = best_s(lambda: _entered(MANY), 1) / MANY
    at_most(f"a line of {MANY} sent in one burst", many_s * 1e3, TARGET_MS, "ms")
    at_most(f"  against a line of {FEW}", many_s / few_s, TARGET_RATIO, "x")


if __name__ == "__main__":
    main()
