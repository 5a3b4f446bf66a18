"""Halts of a program: actions, questions, stops and ends, executed at rest."""

from openacr.cnc import canonical as c
from openacr.mill.card import alarms
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.run.entry_actions import EntryActions
from openacr.mill.run.feeding import Halt
from openacr.mill.run.lifecycle import Event, Lifecycle
from openacr.mill.run.passes import Passes
from openacr.mill.run.program_stream import ProgramStream


class ProgramStops:
    """Executes the halts of a program."""

    def __init__(
        self,
        io: MachineIo,
        stream: ProgramStream,
        entry_actions: EntryActions,
        passes: Passes,
        lifecycle: Lifecycle,
    ) -> None:
        self.asking: c.Ask | None = None
        self._io = io
        self._stream = stream
        self._entry_actions = entry_actions
        self._lifecycle = lifecycle
        self._passes = passes
        self._rest: c.Point | None = None  # where a stop of the program came to rest

    def steps(self, halt: Halt) -> Steps:
        """The steps of a halt; the program continues after it unless it stops or ends."""
        if isinstance(halt, c.Probe):
            yield from self._stream.probe(halt)
        elif isinstance(halt, c.Ask):
            yield from self._asked(halt)
        elif isinstance(halt, c.Stop | c.BlockEnd):
            if not self._is_ignored(halt):
                self._hold(halt)
                return
        elif isinstance(halt, c.End):
            if self._lifecycle.options.is_dry and self._io.settings.returns_to_start:
                yield from self._stream.return_to_begin()
            self._passes.finish()
            return
        else:
            yield from self._entry_actions.steps(halt)
        self._stream.go_on()

    def go_on(self) -> None:
        """Continue after a stop, from where it came to rest; a refusal changes nothing."""
        if self._rest is not None:
            self._stream.require_return_path(self._rest)
        self._stream.go_on()
        if self._rest is not None:
            self._stream.come_back(self._rest)

    def _asked(self, ask: c.Ask) -> Steps:
        """Wait for the operator's answer (INPUT); alarm 61 without an operator."""
        answers = self._stream.host.answers
        if ask.parameter not in answers and not self._lifecycle.has_operator:
            raise AlarmError(alarms.ANSWER_MISSING, f"P{ask.parameter} {ask.text}")
        self.asking = ask
        try:
            yield Until(ask.text, lambda _sample: ask.parameter in answers)
        finally:
            self.asking = None

    def _is_ignored(self, halt: c.Stop | c.BlockEnd) -> bool:
        """Whether a stop has no effect: M1 without the switch, single block switched off."""
        if isinstance(halt, c.BlockEnd):
            return not self._lifecycle.options.is_single
        if halt.pause is c.Pause.OPTIONAL:
            return not self._stops_optionally
        return False

    @property
    def _stops_optionally(self) -> bool:
        switch = self._io.settings.wiring.optional_stop
        wired = self._io.is_in(self._io.machine.poll(), switch)
        return self._lifecycle.options.stops_optionally or wired

    def _hold(self, halt: c.Stop | c.BlockEnd) -> None:
        text = halt.text if isinstance(halt, c.Stop) else ""
        is_by_hand = isinstance(halt, c.Stop) and halt.pause is c.Pause.HAND_RETRACT
        self._rest = None if is_by_hand else self._stream.host.position()
        stop = halt.pause.value if isinstance(halt, c.Stop) else "block"
        self._lifecycle.fire(Event.PROGRAM_STOP, text or stop)
