"""A card on which scenarios are played, and the world they see."""

from collections.abc import Callable, Sequence
from functools import partial
from math import nan

from msgspec import Struct

from openacr.basic.language.lister import Lister
from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.engine.watches import WATCHES, Watch
from openacr.errors import CardError, UserError
from openacr.lang.characters import as_typed, readable, shown
from openacr.map.memory import Memory
from openacr.scenario import card_view
from openacr.scenario.schema import Condition, State
from openacr.scenario.watches import watches
from openacr.scenario.world import Surroundings

_KINDS = {"COM": StreamKind.SERIAL, "DPC": StreamKind.DPCB}


class Failure(Struct, frozen=True):
    """The error that ended a program: its text, and the line as it is listed."""

    error: str
    text: str = ""
    file: str | None = None  # of the project that the line was read from, as the user named it
    file_line: int | None = None

    @property
    def place(self) -> str:
        """`file:line`, where the line is from a file."""
        return f"{self.file}:{self.file_line}" if self.file else ""


class CardWorld:
    """The world of a scenario made of a card, from its present tick on."""

    def __init__(self, card: "PlayedCard") -> None:
        self._card = card
        self._clock, self._begin_tk = card.clock, card.clock.lived_tk
        self.surroundings = card.surroundings
        self.type_text = card.type_text

    @property
    def tick(self) -> int:
        """Servo periods since the start of the run."""
        return self._clock.lived_tk - self._begin_tk

    def read(self, parameter: int) -> float:
        """Read one parameter; one that does not exist (yet) is not a number."""
        try:
            return self._card.memory.read(parameter)
        except CardError:
            return nan

    def bit(self, number: int) -> bool:
        """Read one flag."""
        return self._card.memory.bit(number)

    def position_u(self, axis: int) -> float:
        """Read the actual position of an axis in units."""
        return card_view.actual_u(self._card.memory, axis)

    def commanded_u(self, axis: int) -> float:
        """Read the commanded position of an axis in units."""
        return card_view.commanded_u(self._card.memory, axis)

    def program_state(self, program: int) -> State:
        """Say what a program is doing."""
        return card_view.program_state(self._card.memory, program)


class PlayedCard:
    """A controller as a card on which scenarios are played."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._streams: dict[str, int] = {}
        self._overhear: Callable[[str], None] = lambda text: None
        self._awaits_text = False
        self._was_heard = False
        self.clock = controller.clock
        self.surroundings: Surroundings = controller

    @property
    def memory(self) -> Memory:
        """All parameters and flags."""
        return self._controller.memory

    def has_new_events(self) -> bool:
        """Nothing is watched but what the scenario waits for."""
        return False

    def watch(self, conditions: Sequence[Condition]) -> bool:
        """Make `advance` end when one of these may have changed; False if that is too much."""
        return self._watch(conditions, [])

    def _watch(self, conditions: Sequence[Condition], besides: list[Watch]) -> bool:
        """Watch these conditions and what is given besides; False, and that alone, if too much."""
        wanted = [watch for each in conditions for watch in watches(each, self.memory)]
        self._awaits_text = any(condition.printed for condition in conditions)
        is_possible = len(wanted) + len(besides) <= WATCHES
        self._controller.watch(besides + wanted if is_possible else besides, self._look)
        return is_possible

    def _look(self) -> bool:
        """Read what terminals have answered in this tick; True if a text is waited for."""
        self._read_terminals()
        was_heard, self._was_heard = self._was_heard, False
        return was_heard and self._awaits_text

    def advance(self, ticks: int) -> None:
        """Run the card for `ticks` ticks, fewer if something watched changes."""
        self._controller.advance(ticks)
        self._read_terminals()

    def advance_until(self, bit: int, is_on: bool, ticks: int) -> bool:
        """Run the card until a flag has this state, but no longer than `advance` would."""
        has_come = self._controller.until(bit, is_on, ticks=ticks)
        self._read_terminals()
        return has_come

    def listen(self, hear: Callable[[str], None], overhear: Callable[[str], None]) -> None:
        """Call `hear` with what programs print, `overhear` with what terminals answer."""

        def take(program: int, text: str) -> None:
            self._was_heard = True
            hear(readable(text))

        self._controller.listen(take)
        self._overhear = overhear

    def type_text(self, text: str, stream: str | None) -> None:
        """Type text on a stream, by default the console."""
        name = stream or ""
        if name not in self._streams:
            self._streams[name] = self._open(stream)
        self._controller.type_lines(self._streams[name], as_typed(text))
        self._read_terminals()

    def _open(self, stream: str | None) -> int:
        controller = self._controller
        if stream is None:
            return controller.console
        if stream not in controller.system.sessions:
            known = ", ".join(controller.system.sessions)
            raise UserError(f"stream {stream}: the {controller.model.name} has {known}")
        kind = _KINDS.get(stream[:3], StreamKind.TERMINAL)
        return controller.open_stream(kind, stream)

    def _read_terminals(self) -> None:
        for stream in self._streams.values():
            if data := b"".join(iter(partial(self._controller.take_output, stream), b"")):
                self._was_heard = True
                self._overhear(readable(data.decode("latin-1")))

    def start_all(self) -> None:
        """Start every stored program, as RUN ALL does."""
        self.type_text("SYS\rRUN ALL\r", None)

    def failure(self, program: int) -> Failure:
        """Say what ended a program with an error, and in which line."""
        system, line = self._controller.system, card_view.program_line(self.memory, program)
        stored = system.programs.texts[program].get(line)
        text = Lister(system.aliases.nodes).line(stored.tokens) if stored else ""
        file, file_line = self._controller.origin(program, line) or (None, None)
        error = self._controller.executor.threads.failures.get(program, "error")
        return Failure(error, readable(text), file and shown(file), file_line)
