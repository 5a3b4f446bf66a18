"""Driver of the card for a run: polls its state and sends commands.

Everything goes through the host interface - packets, flags, lines of text - so that the
same run drives the virtual card and a real one.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property

from openacr.client import Card, ConnectionLostError
from openacr.client.errors import GarbledError, NoReplyError
from openacr.client.standstill import cut_all
from openacr.client.values import Number, number_text
from openacr.cnc.occupied import FIRST_CUT, HOLD_AT, MACHINE_AXES, RAN_SHORT, TRIPPED
from openacr.errors import UserError
from openacr.map import numbers as n
from openacr.map.rows import masters
from openacr.map.words import af1, af4, af5, mf1, pf
from openacr.protocol.bits import ClearBit, SetBit
from openacr.protocol.override import FeedrateOverride, RapidOverride
from openacr.protocol.packets import Packet
from openacr.protocol.parameter import SetLong

LINK_ERRORS = (ConnectionLostError, NoReplyError, GarbledError)
CLEAR_S = 2.0  # longest time the card needs to clear a kill
CLOCK_PERIOD_MS = 1 << 31
BITS_PER_WORD = 32
USER_FLAGS = n.FLAG_WORD_BASE + TRIPPED // BITS_PER_WORD  # those that AcroMill occupies
TRIPPED_MASK, RAN_SHORT_MASK = 1 << TRIPPED % BITS_PER_WORD, 1 << RAN_SHORT % BITS_PER_WORD
LIMIT_LATCHES = (
    af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED,
    af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED,
    af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED,
    af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED,
)
FIRST_MODULE_FLAG = (n.XIOI_WORD - n.FLAG_WORD_BASE) * BITS_PER_WORD


@dataclass(frozen=True, slots=True)
class CardState:
    """Sampled state of the card."""

    clock_ms: int
    master: int  # flag word of the master
    counter: int  # packets that have started
    inputs: int
    drives: tuple[int, ...]  # quaternary flag words of the axes in use
    limits: tuple[int, ...]  # quinary flag words
    modules: tuple[int, ...] = ()  # inputs of the expansion modules
    was_reset: bool = False  # the clock of the card has restarted
    has_tripped: bool = False  # the watchdog has stopped the machine
    has_run_short: bool = False  # and has held a planned path that it had too little of
    is_guarded: bool = True  # the watchdog runs, where there is one
    cut: int = 0  # axes whose drives an emergency stop has switched off, as bits
    may_have_lost: bool = False  # sent packets: the connection is a new one

    @property
    def is_moving(self) -> bool:
        """Whether a move is active, buffered or held."""
        return bool(self.master & (mf1.IN_MOTION | mf1.MOVE_BUFFERED))

    @property
    def is_held(self) -> bool:
        """Whether the feed hold has come to rest."""
        return bool(self.master & mf1.IN_FEEDHOLD)

    @property
    def is_in_position(self) -> bool:
        """Whether all axes of the master are inside their in-position band."""
        return not self.master & mf1.NOT_IN_POSITION

    @property
    def is_within_error(self) -> bool:
        """Whether all axes of the master are inside their following-error band."""
        return bool(self.master & mf1.NOT_EXCESS_ERROR)

    @property
    def is_killed(self) -> bool:
        """Whether moves of the master or all motion of an axis are killed, which bars motion."""
        axes = (word & af4.KILL_ALL_MOTION_REQUEST for word in self.drives)
        return bool(self.master & mf1.KILL_ALL_MOVES_REQUEST) or any(axes)

    def is_cut(self, axis: int) -> bool:
        """Whether an emergency stop has switched the drive of an axis off, until it is on again."""
        return bool(self.cut >> axis & 1)

    def input(self, number: int) -> bool:
        """The state of an input of the card (0..31) or of a module (256.. and up)."""
        if number < BITS_PER_WORD:
            return bool(self.inputs >> number & 1)
        module, bit = divmod(number - FIRST_MODULE_FLAG, 2 * BITS_PER_WORD)
        return bool(self.modules[module] >> bit & 1)


def flag_of(word: int, mask: int) -> int:
    """The flag number of one bit of a flag word."""
    return (word - n.FLAG_WORD_BASE) * BITS_PER_WORD + mask.bit_length() - 1


def _cut(flags: int) -> int:
    """The axes whose drives an emergency stop has switched off, as bits."""
    return flags >> FIRST_CUT % BITS_PER_WORD & (1 << MACHINE_AXES) - 1


def may_be_on(word: int) -> bool:
    """Whether the drive of an axis with these quaternary flags is on, or has no enable output."""
    return bool(word & af4.DRIVE_ENABLED) or not word & af4.DRIVE_I_O_ENABLE


class StepLostError(ConnectionLostError):
    """Connection lost in an operation that the next poll repeats."""


class MachineDriver:
    """The axes of one master of a card."""

    def __init__(
        self, card: Card, axes: Sequence[int], master: int = 0, *, rounds_corners: bool = False
    ) -> None:
        if not 0 <= master < 8:
            raise UserError(f"master {master}: a machine runs on master 0 to 7")
        self.card = card
        self.axes = tuple(axes)
        self.master = master
        self.rounds_corners = rounds_corners  # supports path tolerances: only our own card does
        self._passed_ms = 0
        self._clock_ms: int | None = None
        self.is_dropping = False  # moves are killed on purpose
        self._clear_by_s: float | None = None  # a kill that lasts longer is not our own
        self._modules = 0
        self._watchdog: int | None = None
        self._connections = card.connections
        self._has_sent = False  # since the last poll
        self._has_lost = False  # packets that were being sent when a connection broke
        self._barred = ""  # why nothing more is sent to the card
        self.polled: CardState | None = None  # as the last poll has read it

    # --- seeing -----------------------------------------------------------------------

    @cached_property
    def _watched(self) -> list[int]:
        drives = [af4.word[axis] for axis in self.axes]
        limits = [af5.word[axis] for axis in self.axes]
        head = [n.P_GLOBAL_SYSTEM_CLOCK, mf1.word[self.master], self.counter, n.W_INPUTS]
        modules = [n.XIOI_WORD + n.XIOI_WORD_STRIDE * one for one in range(self._modules)]
        watchdog = [] if self._watchdog is None else [pf.word[self._watchdog]]
        return [*head, *drives, *limits, USER_FLAGS, *watchdog, *modules]

    @property
    def counter(self) -> int:
        """The parameter that counts the packets of the master."""
        return masters.move_counter[self.master]

    def watch_modules(self, count: int) -> None:
        """Include the inputs of `count` expansion modules; call before the first poll."""
        self._modules = count
        self.__dict__.pop("_watched", None)

    def watch_program(self, program: int | None) -> None:
        """Include the watchdog in this program of the card in the poll; None: there is none."""
        self._watchdog = program
        self.__dict__.pop("_watched", None)

    def poll(self) -> CardState:
        """Read the state of the card."""
        clock, master, counter, inputs, *words = map(int, self._read_many(self._watched))
        is_new = self.card.connections != self._connections
        self._has_lost = self._has_lost or (is_new and self._has_sent)
        self._connections, self._has_sent = self.card.connections, False
        step_ms = 0 if self._clock_ms is None else (clock - self._clock_ms) % CLOCK_PERIOD_MS
        was_reset = step_ms > CLOCK_PERIOD_MS // 2  # backwards
        self._passed_ms += 0 if was_reset else step_ms
        self._clock_ms = clock
        count = len(self.axes)
        drives, limits, (flags, *words) = (
            words[:count],
            words[count : 2 * count],
            words[2 * count :],
        )
        is_watched = self._watchdog is not None
        program, modules = (words[0], words[1:]) if is_watched else (pf.PROGRAM_RUNNING, words)
        sample = CardState(
            clock, master, counter, inputs, tuple(drives), tuple(limits), tuple(modules),
            was_reset=was_reset,
            has_tripped=is_watched and bool(flags & TRIPPED_MASK),
            has_run_short=is_watched and bool(flags & RAN_SHORT_MASK),
            is_guarded=bool(program & pf.PROGRAM_RUNNING),
            cut=_cut(flags),
            may_have_lost=self._has_lost,
        )  # fmt: skip
        self._note_clearing(is_killed=sample.is_killed)
        self.polled = sample
        return sample

    def _note_clearing(self, *, is_killed: bool) -> None:
        by_s = self._clear_by_s
        if by_s is not None and (not is_killed or self.now_s > by_s):
            self.is_dropping, self._clear_by_s = False, None

    @property
    def now_s(self) -> float:
        """Card time of the last poll, counted from the first."""
        return self._passed_ms / 1000.0

    def pause(self, seconds: float) -> None:
        """Let time pass."""
        self.card.pause(seconds)

    def read(self, parameter: int) -> float:
        """A parameter of the card."""
        self._require_attached()
        return float(self.card.read(parameter))

    def _read_many(self, parameters: list[int]) -> list[Number]:
        self._require_attached()
        return self.card.read_many(parameters)

    def read_rows(self, parameters: list[int]) -> list[float]:
        """Several parameters of the card with one request."""
        return [float(value) for value in self._read_many(parameters)]

    def axis_values(self, *rows: tuple[int, ...]) -> list[int]:
        """Rows of all axes in use, one after the other, e.g. `axes.actual_position`."""
        places = [row[axis] for row in rows for axis in self.axes]
        return [int(value) for value in self._read_many(places)]

    def axis_flags(self, word: tuple[int, ...]) -> list[int]:
        """One flag word of all axes in use, e.g. `af1.word`."""
        return [int(each) for each in self._read_many([word[axis] for axis in self.axes])]

    # --- commanding ----------------------------------------------------------------------

    def detach(self, reason: str) -> None:
        """Stop all exchange with the card: every later attempt is a ConnectionLostError."""
        self._barred = reason

    def _transmit(self, *packets: Packet) -> None:
        self._require_attached()
        self._has_sent = True
        self.card.tell(*packets)

    def _require_attached(self) -> None:
        if self._barred:
            raise ConnectionLostError(f"{self.card.name}: {self._barred}")

    @contextmanager
    def repeating(self) -> Iterator[None]:
        """Context whose packets the caller sends again if the connection breaks (StepLostError).

        Later polls then report `may_have_lost`, because packets have no answer.
        """
        try:
            yield
        except ConnectionLostError as lost:
            self._has_lost = True
            raise StepLostError(str(lost)) from lost

    def forget_losses(self) -> None:
        """Clear `may_have_lost`: what was lost is sent again or no longer needed."""
        self._has_lost = False

    def send(self, packets: Iterable[Packet]) -> None:
        """Send moves to the buffer of the master, only on the connection of the last poll.

        On a newer connection they could follow moves that were lost; so could what tells how far
        these may be run.
        """
        if self._has_lost or self.card.connections != self._connections:
            raise ConnectionLostError(f"{self.card.name}: connected again since the last poll")
        self._transmit(*packets)

    def limit_jerk(self, jerk_ups3: float) -> None:
        """Limit the jerk of the moves to come (JRK), 0 = not at all."""
        self.type([f"JRK {number_text(jerk_ups3)}"])

    def write(self, parameter: int, value: float) -> None:
        """Set a parameter of the card."""
        self._require_attached()
        self.card.write(parameter, value)

    def set_flag(self, number: int, on: bool) -> None:
        """Set or clear a flag."""
        self._transmit(SetBit(number) if on else ClearBit(number))

    def _request(self, mask: int, on: bool = True) -> None:
        self.set_flag(flag_of(mf1.word[self.master], mask), on)

    def hold(self) -> None:
        """Request a feed hold."""
        self._request(mf1.FEEDHOLD_REQUEST)

    def go_on(self) -> None:
        """Request a cycle start; a feed hold that is still pending is withdrawn."""
        self._request(mf1.FEEDHOLD_REQUEST, False)
        self._request(mf1.CYCLE_START_REQUEST)

    def stop(self) -> None:
        """Request a feed hold, after which all moves are dropped."""
        self.is_dropping = True
        self._request(mf1.STOP_ALL_MOVES_REQUEST)

    def bar(self) -> None:
        """Bar moves at rest by killing them; pending requests are withdrawn."""
        self._request(mf1.KILL_ALL_MOVES_REQUEST)
        self._request(mf1.STOP_ALL_MOVES_REQUEST, False)
        self._request(mf1.FEEDHOLD_REQUEST, False)

    def clear_kill(self) -> None:
        """Clear the kill of the moves of the master.

        A stop or feed hold requested while moves were killed is still pending on the card and
        would act on the next moves: both are withdrawn first. So is what bars their start.
        """
        self._transmit(self.barring(False))
        self._request(mf1.STOP_ALL_MOVES_REQUEST, False)
        self._request(mf1.FEEDHOLD_REQUEST, False)
        self.is_dropping, self._clear_by_s = True, self.now_s + CLEAR_S
        self._request(mf1.KILL_ALL_MOVES_REQUEST, False)

    def kill(self) -> None:
        """Kill the motion of every axis in use."""
        self.is_dropping = True
        self._set_kills(True)

    def disable(self) -> None:
        """Kill all motion, end all programs and switch all drives off, moving or not.

        Drives of axes in use that were on are noted on the card, for `enabling`.
        """
        self._require_attached()
        cut_all(self.card)
        words = () if self.polled is None else self.polled.drives
        were_on = [axis for axis, word in zip(self.axes, words, strict=False) if may_be_on(word)]
        self._transmit(*(SetBit(FIRST_CUT + axis) for axis in were_on))

    def read_cut(self) -> list[int]:
        """Axes whose drives an emergency stop has switched off, read now: no poll may be due."""
        cut = _cut(int(self.read(USER_FLAGS)))
        return [axis for axis in self.axes if cut >> axis & 1]

    def release(self) -> None:
        """Clear a kill so that axes and master may move; drives stay as they are.

        The card ramps killed motion down as a jog; that distance becomes position.
        """
        self.fold_jogs()
        self._set_kills(False)
        self.clear_kill()
        self.go_on()

    def _set_kills(self, on: bool) -> None:
        self._set_of_axes(af4.word, af4.KILL_ALL_MOTION_REQUEST, on)

    def clear_limits(self) -> None:
        """Clear the latches of limits; an axis that still moves into one sets it again."""
        for latch in LIMIT_LATCHES:
            self._set_of_axes(af5.word, latch, False)

    def _set_of_axes(self, word: tuple[int, ...], mask: int, on: bool) -> None:
        """Set or clear one flag of every axis in use, all at once."""
        flags = (flag_of(word[axis], mask) for axis in self.axes)
        self._transmit(*(SetBit(flag) if on else ClearBit(flag) for flag in flags))

    def is_jogging(self) -> bool:
        """Whether an axis in use is jogged or ramps down after a kill."""
        return any(word & af1.JOG_ACTIVE for word in self.axis_flags(af1.word))

    def fold_jogs(self) -> None:
        """Convert the jog offsets of all axes into position; call at rest."""
        self.type(f"AXIS{axis} JOG RES" for axis in self.axes)

    def override(self, feed: float, rapid: float) -> None:
        """Send feed and rapid override, 1 = as programmed."""
        self._transmit(FeedrateOverride.of([self.master], feed))
        self._transmit(RapidOverride.of([self.master], rapid))

    def barring(self, on: bool) -> Packet:
        """The packet that keeps moves which wait from beginning, or lets them begin."""
        flag = flag_of(mf1.word[self.master], mf1.START_MOVE_INHIBIT)
        return SetBit(flag) if on else ClearBit(flag)

    def holding_at(self, move: int) -> Packet:
        """The packet that lets the watchdog hold the feed when this move begins; 0: at none."""
        return SetLong(HOLD_AT, move)

    def let_run(self) -> None:
        """Let the watchdog hold the feed at no move."""
        self._transmit(self.holding_at(0))

    def reset_counter(self) -> None:
        """Reset the packet counter to zero."""
        self.write(self.counter, 0)

    def type(self, lines: Iterable[str]) -> None:
        """Send lines of text to the program of the master."""
        self._require_attached()
        for line in lines:
            self.card.command(line, program=self.master)
