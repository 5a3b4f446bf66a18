"""User messages: texts shown while an input, output or flag has a given state."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from openacr.errors import UserError
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import Store
from openacr.sysvar import Store as SysvarStore
from openacr.sysvar.tabs import MESSAGES

MOST = len(MESSAGES.defined)
POLL_S = 0.05
MOST_KEPT = 10_000  # displays of the history; a flag may blink for days
WHITE, RED, LETTERS, LONGEST = 15, 4, 40, 132


@dataclass(frozen=True, slots=True)
class Message:
    """One record: shown while `bit` is on, or off; colours are 0 to 15 as on the screens."""

    number: int
    bit: int
    text: str
    is_shown_on: bool = True
    text_color: int = WHITE
    back_color: int = RED
    size: int = LETTERS
    is_alarm: bool = False

    @property
    def shown(self) -> str:
        """The text cut to the length set in the record."""
        return self.text[: self.size]


def definitions(store: Store) -> Iterator[Message]:
    """The messages that are defined."""
    for number, defined in enumerate(MESSAGES.defined):
        if store.read(defined):
            yield Message(
                number,
                bit=int(store.read(MESSAGES.bit[number])),
                text=store.read_text(MESSAGES.text[number]),
                is_shown_on=bool(store.read(MESSAGES.level[number])),
                text_color=int(store.read(MESSAGES.text_colour[number])),
                back_color=int(store.read(MESSAGES.back_colour[number])),
                size=int(store.read(MESSAGES.size[number])),
                is_alarm=bool(store.read(MESSAGES.alarm[number])),
            )


def free_number(store: Store) -> int:
    """The first message that is not defined."""
    for number, defined in enumerate(MESSAGES.defined):
        if not store.read(defined):
            return number
    raise UserError(f"{MOST} messages are defined; one has to be removed first")


def define(store: SysvarStore, message: Message) -> None:
    """Write a message to the store."""
    _require_number(message.number)
    if message.bit < 0:
        raise UserError(f"bit {message.bit}: a message needs an input, output or flag, 0 or higher")
    n = message.number
    store.write(MESSAGES.defined[n], 1)
    store.write(MESSAGES.bit[n], message.bit)
    store.write(MESSAGES.level[n], message.is_shown_on)
    store.write(MESSAGES.text_colour[n], message.text_color)
    store.write(MESSAGES.back_colour[n], message.back_color)
    store.write(MESSAGES.size[n], message.size)
    store.write(MESSAGES.alarm[n], message.is_alarm)
    store.write_text(MESSAGES.text[n], message.text)


def remove(store: Store, number: int) -> None:
    """Delete a message from the store."""
    _require_number(number)
    if not store.read(MESSAGES.defined[number]):
        raise UserError(f"message {number} is not defined")
    store.write(MESSAGES.defined[number], 0)


def _require_number(number: int) -> None:
    if not 0 <= number < MOST:
        raise UserError(f"message {number}: messages are numbered 0 to {MOST - 1}")


@dataclass(slots=True)
class Showing:
    """One display of a message; `until_s` is None while it is shown."""

    message: Message
    at_s: float
    until_s: float | None = None


@dataclass(slots=True)
class Messages:
    """Polls the bits of all messages of a machine, in card time."""

    io: MachineIo
    defined: Sequence[Message]
    changed: Callable[[Message, bool], None]
    history: deque[Showing] = field(default_factory=lambda: deque(maxlen=MOST_KEPT))
    _shown: dict[int, Showing] = field(default_factory=dict)
    _due_s: float = 0.0

    @property
    def shown(self) -> list[Message]:
        """The messages shown now, by number."""
        return [self._shown[number].message for number in sorted(self._shown)]

    def poll(self, now_s: float) -> None:
        """Read the bits if the poll period has passed."""
        if not self.defined or now_s < self._due_s:
            return
        self._due_s = now_s + POLL_S
        states = self.io.machine.card.read_bits([each.bit for each in self.defined])
        for message, state in zip(self.defined, states, strict=True):
            is_on = (state != self._is_inverted(message.bit)) == message.is_shown_on
            if is_on and message.number not in self._shown:
                showing = self._shown[message.number] = Showing(message, now_s)
                self.history.append(showing)
                self.changed(message, True)
            elif not is_on and message.number in self._shown:
                self._shown.pop(message.number).until_s = now_s
                self.changed(message, False)

    def _is_inverted(self, bit: int) -> bool:
        """Whether the store inverts an input or output."""
        settings = self.io.settings
        if self.io.has_input(bit):
            return settings.is_input_inverted(bit)
        return bit in self.io.outputs and settings.is_output_inverted(bit)
