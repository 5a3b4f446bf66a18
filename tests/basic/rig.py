"""A card whose programs and typed lines are executed for real, tick by tick, without motion."""

from tests.basic.machine import Machine

from openacr.basic.channels.session import Session
from openacr.basic.language.registry import Level


class Rig(Machine):
    """`run` gives the output of a program; no prompts, PROG8 and PROG9 have memory."""

    def __init__(self) -> None:
        super().__init__()
        self.memory = self.card.memory
        self.type("DIM P(100)", "DIM PROG8(20000)", "DIM PROG9(20000)", "PROG0")

    def connect(self, name: str) -> Session:
        session = super().connect(name)
        session.echo = 4
        return session

    def value(self, expression: str) -> str:
        return self.type(f"?{expression}").rstrip("|")

    def store(self, program: int, *lines: str) -> None:
        self.session.go(Level.PROG, program)
        assert self.type("PROGRAM", *lines, "ENDP") == ""

    def run(self, *lines: str, ticks: int = 400) -> str:
        """Store and run program 0, and give what it prints (and the error that ends it)."""
        self.store(0, *lines)
        self.session.listening_to = 0
        self.executor.run_program(0)
        self.advance(ticks)
        self.session.listening_to = None
        return self.sent()

    def bit(self, number: int) -> bool:
        return self.memory.bit(number)

    def is_running(self, program: int = 0) -> bool:
        return self.executor.is_running(program)
