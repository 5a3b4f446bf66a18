"""The state machine of a slave (AL): what is checked in which transition."""

from openacr.fieldbus.ethercat.wire.registers import ERROR, STATE_MASK, AlCode, State

FIRST_OUTPUTS_NS = 1_000_000_000  # how long outputs are awaited on the way to OP
_ORDER = [State.INIT, State.PREOP, State.SAFEOP, State.OP]


class Refused(Exception):  # noqa: N818 - it is no error of the program
    """A transition that the slave refuses, with the code it reports."""

    def __init__(self, code: AlCode) -> None:
        super().__init__(code.text)
        self.code = code


class Transitions:
    """What a slave does on its transitions; each may raise Refused."""

    def start_mailbox(self) -> None:
        """INIT to PREOP."""

    def start_inputs(self) -> None:
        """PREOP to SAFEOP."""

    def start_outputs(self) -> bool:
        """SAFEOP to OP; False while outputs or SYNC0 are still awaited."""
        return True

    def missing(self) -> AlCode:
        """What was awaited in vain."""
        return AlCode.NO_OUTPUTS

    def stop_outputs(self, code: AlCode) -> None:
        """OP to a lower state; with a code by itself."""

    def stop_inputs(self) -> None:
        """SAFEOP to a lower state."""

    def stop_mailbox(self) -> None:
        """PREOP to INIT."""


class Machine:
    """The state, the error flag and its code."""

    def __init__(self, acts: Transitions) -> None:
        self._acts = acts
        self.state = State.INIT
        self.code = AlCode.NONE
        self.is_error = False
        self._until: int | None = None

    @property
    def status(self) -> int:
        """As AL_STATUS shows it."""
        return self.state | (ERROR if self.is_error else 0)

    def request(self, control: int, now: int) -> None:
        """The master wrote AL_CONTROL."""
        if control & ERROR:
            self.is_error, self.code = False, AlCode.NONE
        wanted = control & STATE_MASK
        if wanted not in (*_ORDER, State.BOOT):
            self._fail(AlCode.UNKNOWN_STATE)
        elif wanted == State.BOOT:
            self._fail(AlCode.NO_BOOT)
        elif self.is_error and wanted > self.state:
            return  # until it is acknowledged
        else:
            self._go(State(wanted), now)

    def _go(self, wanted: State, now: int) -> None:
        self._until = None
        if wanted < self.state:
            self._down(wanted)
        elif wanted > self.state:
            if _ORDER.index(wanted) > _ORDER.index(self.state) + 1:
                self._fail(AlCode.INVALID_CHANGE)
            else:
                self._up(wanted, now)

    def _up(self, wanted: State, now: int) -> None:
        try:
            if wanted is State.PREOP:
                self._acts.start_mailbox()
            elif wanted is State.SAFEOP:
                self._acts.start_inputs()
            elif not self._acts.start_outputs():
                self._until = now + FIRST_OUTPUTS_NS
                return
        except Refused as refused:
            self._fail(refused.code)
        else:
            self.state = wanted

    def wait(self, now: int) -> None:
        """Time passed: what is awaited on the way to OP may be there, or be missing too long."""
        if self._until is None:
            return
        try:
            if self._acts.start_outputs():
                self.state, self._until = State.OP, None
            elif now >= self._until:
                self._fail(self._acts.missing())
        except Refused as refused:
            self._fail(refused.code)

    def drop(self, wanted: State, code: AlCode) -> None:
        """Go down by itself, with an error."""
        self._down(wanted, code)
        self._fail(code)

    def _down(self, wanted: State, code: AlCode = AlCode.NONE) -> None:
        self._until = None
        if self.state is State.OP:
            self.state = State.SAFEOP
            self._acts.stop_outputs(code)
        if self.state is State.SAFEOP and wanted < State.SAFEOP:
            self.state = State.PREOP
            self._acts.stop_inputs()
        if self.state is State.PREOP and wanted is State.INIT:
            self.state = State.INIT
            self._acts.stop_mailbox()

    def _fail(self, code: AlCode) -> None:
        self.is_error, self.code, self._until = True, code, None
