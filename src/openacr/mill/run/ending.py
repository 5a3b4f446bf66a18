"""Endings of a program: its last block, ABORT or an alarm, and the kill of all motion.

However a program ends, spindle, coolant and beam are switched off first; this does not wait
for the machine to come to rest. Every wait of an ending has a limit; if the machine does not
come to rest within it, its drives are switched off (alarm 15).
"""

from contextlib import ExitStack

from openacr.mill.card import alarms
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.run.entry_actions import EntryActions
from openacr.mill.run.lifecycle import Lifecycle
from openacr.mill.run.pausing import Pausing
from openacr.mill.run.program_stream import ProgramStream


class Ending:
    """Ends the program of one machine."""

    def __init__(
        self,
        io: MachineIo,
        stream: ProgramStream,
        entry_actions: EntryActions,
        pausing: Pausing,
        player: ActionPlayer,
        lifecycle: Lifecycle,
    ) -> None:
        self._io = io
        self._machine = io.machine
        self._stream = stream
        self._entry_actions = entry_actions
        self._pausing = pausing
        self._player = player
        self._lifecycle = lifecycle

    def finish(self) -> None:
        """End a completed program at rest; blocks typed one by one leave outputs on."""
        if not self._lifecycle.options.is_mdi:
            self._entry_actions.off()
        self._leave()

    def abort(self) -> None:
        """Bring the machine to rest, drop its moves, switch everything off.

        The hold is requested at once: a host that exits may never poll the card again.
        """
        with ExitStack() as then:  # all of these, even if one fails; in reverse order
            then.callback(self._player.begin, self._to_rest())
            then.callback(self._leave)
            if not self._lifecycle.options.is_dry:
                then.callback(self._entry_actions.off)
            then.callback(self._stream.hold)

    def kill(self) -> None:
        """Kill all motion, switch drives and spindle off, end the program."""
        with ExitStack() as then:  # all of these, even if one fails; in reverse order
            then.callback(self._player.close)
            then.callback(self._leave)
            then.callback(self._io.output, self._io.settings.wiring.drive_enable, False)
            then.callback(self._entry_actions.off)
            self._machine.kill()

    def cut_power(self) -> None:
        """As `kill`, then switch the drives of all axes of the card off."""
        with ExitStack() as then:
            then.callback(self._machine.disable)
            then.callback(self.kill)

    def _leave(self) -> None:
        self._pausing.close()
        self._stream.end()
        self._entry_actions.is_tapping = False

    def _to_rest(self) -> Steps:
        yield self._stream.stops()
        yield from self._stream.drop_moves()
        yield Until(
            "axes stop",
            lambda _sample: not self._machine.is_jogging(),
            self._io.settings.rest_s,
            alarms.NO_REST,
        )
        self._machine.fold_jogs()  # of a cancelled homing
        self._machine.go_on()  # no move is left: a hold must not outlast its program
