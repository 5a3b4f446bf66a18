"""A card whose programs and typed lines are executed for real, tick by tick, without motion."""

from openacr.basic.channels.session import Session
from openacr.basic.execute.control import ProgramControl
from openacr.basic.execute.executor import Executor
from openacr.basic.execute.system import System
from openacr.basic.language.registry import Level
from openacr.map.rows import system
from openacr.models import ACR8020
from openacr.motion.card import Card


class Rig:
    """`type` gives the answer of a line (`|` for CR LF), `run` the output of a program."""

    def __init__(self) -> None:
        self.card = Card(ACR8020)
        self.memory = self.card.memory
        self.system = System(self.card)
        self.executor = Executor(self.system)
        self.system.runner = self.executor
        self.system.control = ProgramControl(self.system, self.executor)
        self.session = self.connect("COM1")
        self.tick = 0
        self.type("DIM P(100)", "DIM PROG8(20000)", "DIM PROG9(20000)", "PROG0")

    def connect(self, name: str) -> Session:
        session = self.system.sessions[name]
        session.connect()
        session.echo = 4
        return session

    def type(self, *lines: str) -> str:
        for line in lines:
            self.session.feed_line(line)
        return self.sent()

    def sent(self, session: Session | None = None) -> str:
        return (session or self.session).take_output().decode("latin-1").replace("\r\n", "|")

    def value(self, expression: str) -> str:
        return self.type(f"?{expression}").rstrip("|")

    def store(self, program: int, *lines: str) -> None:
        self.session.go(Level.PROG, program)
        assert self.type("PROGRAM", *lines, "ENDP") == ""

    def pass_ticks(self, count: int) -> None:
        for _ in range(count):
            self.tick += 1
            self.memory.I[system.tick_low] = self.tick
            self.executor.step(self.tick)

    def run(self, *lines: str, ticks: int = 400) -> str:
        """Store and run program 0, and give what it prints (and the error that ends it)."""
        self.store(0, *lines)
        self.session.listening_to = 0
        self.executor.run_program(0)
        self.pass_ticks(ticks)
        self.session.listening_to = None
        return self.sent()

    def bit(self, number: int) -> bool:
        return self.memory.bit(number)

    def is_running(self, program: int = 0) -> bool:
        return self.executor.is_running(program)
