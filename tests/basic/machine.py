"""A card without servo interrupt: channels, programs and their clock."""

from openacr.basic.channels.session import Session
from openacr.basic.execute.control import ProgramControl
from openacr.basic.execute.executor import Executor
from openacr.basic.execute.system import System
from openacr.map.rows import system
from openacr.models import ACR8020, Model
from openacr.motion.card import Card

SLOW_SCAN_TICKS = 100


class Machine:
    """Channels are connected on demand; `|` in answers stands for CR LF."""

    def __init__(self, model: Model = ACR8020, channel: str = "COM1") -> None:
        self.card = Card(model)
        self.system = System(self.card)
        self.executor = Executor(self.system)
        self.control = ProgramControl(self.system, self.executor)
        self.system.runner = self.executor
        self.system.control = self.control
        self.session = self.connect(channel)

    def connect(self, name: str) -> Session:
        session = self.system.sessions[name]
        session.connect()
        return session

    def type(self, *lines: str, on: Session | None = None) -> str:
        session = on or self.session
        for line in lines:
            session.feed_line(line)
        return self.sent(session)

    def key(self, text: str, on: Session | None = None) -> None:
        for character in text:
            (on or self.session).typed(ord(character))

    def sent(self, session: Session | None = None) -> str:
        data = (session or self.session).take_output()
        return data.decode("latin-1").replace("\r\n", "|")

    def advance(self, ticks: int = 100) -> None:
        row = system.tick_low
        for _ in range(ticks):
            self.card.memory.I[row] += 1
            self.executor.step(self.card.clock.tick)
            if self.card.clock.tick % SLOW_SCAN_TICKS == 0:
                self.control.scan()

    def load(self, program: int, *lines: str) -> None:
        """Enter free-form text, on a channel of its own."""
        other = self.connect("COM2")
        answer = self.type(f"PROG {program}", "PROGRAM", *lines, "ENDP", on=other)
        assert answer == f"P{program:02d}>" * (len(lines) + 3), answer
