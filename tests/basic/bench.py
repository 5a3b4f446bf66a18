"""A card whose immediate lines are executed at once by a few lines of Python."""

from collections.abc import Callable

from tests.basic.parsing import parse_line

import openacr.basic.commands
import openacr.basic.commands.strings  # noqa: F401 - both enter their words
from openacr.basic.channels.session import Session
from openacr.basic.execute.system import System
from openacr.basic.language.nodes import (
    Alias,
    Apply,
    Binary,
    Expr,
    Flag,
    Local,
    Move,
    Number,
    Op,
    Parameter,
    Statement,
    String,
    StringLocal,
    Unary,
)
from openacr.basic.language.registry import Level
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.memory.string_storage import StringBlock
from openacr.basic.vm.run import Evaluator, Run, Wait
from openacr.errors import CardError
from openacr.map.rows import storage
from openacr.messages import UNDEFINED_VARIABLE
from openacr.models import ACR8020, Model
from openacr.motion.card import Card


class Values:
    """Evaluates what the tests of this package write."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.program = 0

    def value(self, thread: int, node: Expr) -> float:
        memory = self.system.card.memory
        match node:
            case Number(value):
                return value
            case Alias(_, target):
                return self.value(thread, target)
            case Parameter(index):
                return memory.read(int(self.value(thread, index)))
            case Flag(index):
                return -memory.bit(int(self.value(thread, index)))
            case Local(_, index):
                return memory.I[
                    memory.I[storage.lv_base[self.program]] + int(self.value(thread, index))
                ]
            case Unary(Op.MINUS, operand):
                return -self.value(thread, operand)
            case Binary(Op.PLUS, left, right):
                return self.value(thread, left) + self.value(thread, right)
            case Binary(Op.DIVIDE, left, right):
                return self.value(thread, left) / self.value(thread, right)
        raise NotImplementedError(node)

    def text(self, thread: int, node: Expr) -> str:
        match node:
            case String(text):
                return text
            case StringLocal(index):
                place = int(self.value(thread, index))
                return self._strings(place).read(place)
            case Apply(function, arguments):
                assert function.apply is not None
                return str(function.apply(*(self.value(thread, node) for node in arguments)))
        raise NotImplementedError(node)

    def assign(self, thread: int, target: Expr, value: float | str) -> None:
        match target:
            case StringLocal(index):
                place = int(self.value(thread, index))
                self.system.storage.locals.strings[self.program].variable(place).write(
                    place, str(value)
                )
            case Parameter(index):
                self.system.card.memory.write(int(self.value(thread, index)), float(value))
            case _:
                raise CardError(UNDEFINED_VARIABLE)

    def _strings(self, place: int) -> StringBlock:
        return self.system.storage.locals.strings[self.program].variable(place)

    def execute(self, run: Run, statement: Statement) -> Wait | None:
        indices = (run.integer(node) for node in statement.indices)
        forms = zip(statement.command.forms, statement.arguments, strict=True)
        arguments = [form.evaluate(run, read) for form, read in forms]
        run.prefix = statement.prefix
        result: Wait | None = statement.command.handler(run, *indices, *arguments)
        return result


class Steps:
    """Executes immediate lines; a statement that waits leaves its session busy."""

    def __init__(self, system: System) -> None:
        self.values = Values(system)
        self.system = system
        self.waiting: dict[int, Wait] = {}
        self.cancelled: list[str] = []

    def start(self, session: Session, line: StoredLine) -> None:
        self.values.program = session.program or 0
        evaluator: Evaluator = self.values
        run = Run(
            self.system.card, session.thread, session.program, session.level, False,
            evaluator, session.write, channel=session, system=self.system,
        )  # fmt: skip
        for block in line.tree.blocks:
            for statement in block:
                assert not isinstance(statement, Move)
                wait = self.values.execute(run, statement)
                if wait is not None:
                    self.waiting[session.thread] = wait
                    return
        session.finished()

    def cancel(self, session: Session) -> None:
        self.cancelled.append(session.name)

    def is_waiting(self, thread: int) -> bool:
        return thread in self.waiting


class Calls:
    """Stands for the executor of programs: records its commands."""

    def __init__(self) -> None:
        self.running: set[int] = set()
        self.calls: list[tuple[object, ...]] = []

    def is_running(self, owner: int) -> bool:
        return owner in self.running

    def run(self, owner: int, line: int | None = None) -> None:
        self.running.add(owner)
        self.calls.append(("run", owner, line))

    def halt(self, owner: int) -> None:
        self.running.discard(owner)
        self.calls.append(("halt", owner))

    def _record(name: str) -> Callable[..., None]:  # type: ignore[misc] # noqa: N805
        def call(self: "Calls", *arguments: object) -> None:
            self.calls.append((name, *arguments))

        return call

    pause, resume = _record("pause"), _record("resume")
    block, auto, step, trace = map(_record, ("block", "auto", "step", "trace"))


class Bench:
    """One card with its channels; `type` gives the answer of a line, `|` for CR LF."""

    def __init__(self, model: Model = ACR8020, channel: str = "COM1") -> None:
        self.card = Card(model)
        self.system = System(self.card)
        self.control = Calls()
        self.runner = Steps(self.system)
        self.system.control = self.control
        self.system.runner = self.runner
        self.session = self.connect(channel)

    def connect(self, channel: str) -> Session:
        session = self.system.sessions[channel]
        session.connect()
        return session

    def type(self, *lines: str, on: Session | None = None) -> str:
        session = on or self.session
        for line in lines:
            session.feed_line(line)
        return self.sent(session)

    def sent(self, session: Session | None = None) -> str:
        data = (session or self.session).take_output()
        return data.decode("latin-1").replace("\r\n", "|")

    def stored_run(self, program: int) -> Run:
        """What a statement inside a running program gets."""
        self.runner.values.program = program
        return Run(
            self.card, program, program, Level.PROG, True, self.runner.values,
            lambda text: self.system.listeners.print(program, text), system=self.system,
        )  # fmt: skip

    def execute(self, program: int, text: str) -> Wait | None:
        """One statement as a running program executes it."""
        line = parse_line(text, self.system.scope(Level.PROG, program, stored=True))
        (statement,) = line.blocks[0]
        assert isinstance(statement, Statement)
        return self.runner.values.execute(self.stored_run(program), statement)
