"""An emulated slave: its controller, states, mailbox and process data.

A device is a subclass that describes itself, adds its objects, and acts on `step` (time passes),
`outputs_changed`, `inputs_wanted` and `outputs_off`.
"""

from openacr.fieldbus.ethercat.emulated.controller import Controller
from openacr.fieldbus.ethercat.emulated.dictionary import (
    INPUT,
    OUTPUT,
    RO,
    Access,
    Dictionary,
    Entry,
    SdoError,
)
from openacr.fieldbus.ethercat.emulated.pdo import (
    RECEIVE_ASSIGNED,
    TRANSMIT_ASSIGNED,
    Image,
    Mapping,
)
from openacr.fieldbus.ethercat.emulated.sdo_server import SdoServer
from openacr.fieldbus.ethercat.emulated.states import Machine, Refused, Transitions
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.ethercat.wire.mailbox import Protocol
from openacr.fieldbus.ethercat.wire.managers import (
    DIRECTION_MASK,
    INPUTS_CONTROL,
    MAILBOX_IN_CONTROL,
    MAILBOX_MODE,
    MAILBOX_OUT_CONTROL,
    MODE_MASK,
    OUTPUTS_CONTROL,
    WATCHED,
    WRITTEN_BY_MASTER,
    SyncUse,
)
from openacr.fieldbus.ethercat.wire.registers import AlCode, Register, State

MAILBOX_BYTES = 256
OUT_MAILBOX, IN_MAILBOX = 0x1000, 0x1100
OUTPUTS, INPUTS = 0x1200, 0x1600  # three buffers each; the master sees the first
COE_DETAILS = 0x01 | 0x02 | 0x04 | 0x08 | 0x20  # SDO, information, assignment, mapping, complete
DIVIDER_NS = 40
VENDOR = 0x00_0A_C2  # of no company: emulated devices are not on sale
SM_OUT, SM_IN, SM_OUTPUTS, SM_INPUTS = 0, 1, 2, 3
COMMUNICATION_ERROR = 0x10  # of the error register


class Slave(Transitions):
    """One slave; `name` is shown to people, `description` is what its EEPROM says."""

    def __init__(self, description: sii.Description, name: str) -> None:
        self.name = name
        self.description = description
        self.is_powered = True
        self.dictionary = Dictionary()
        self.machine = Machine(self)
        self.server = SdoServer(self.dictionary, lambda: self.machine.state)
        self._mappings = [
            Mapping(self.dictionary, RECEIVE_ASSIGNED, Access.RECEIVE, description.receive),
            Mapping(self.dictionary, TRANSMIT_ASSIGNED, Access.TRANSMIT, description.transmit),
        ]
        self._images = [Image([]), Image([])]
        self._places = [0, 0]  # of the images in the memory
        self._written_at: int | None = None
        self._last_mail = b""
        self._add_identity()
        self.add_objects()
        for mapping in self._mappings:
            mapping.add()
        self.controller = Controller(self, sii.build(description))

    # -- for devices -------------------------------------------------------------------------

    def add_objects(self) -> None:
        """Add the objects of the device."""

    def outputs_changed(self) -> None:
        """New outputs are in the entries."""

    def inputs_wanted(self) -> None:
        """Put the inputs into the entries."""

    def outputs_off(self, code: AlCode) -> None:
        """Outputs are no longer served; with a code because of an error."""

    def step(self, now: int) -> None:
        """A period of the world has passed."""

    def shown(self) -> str:
        """What a person sees of the device beside its state."""
        return ""

    def restarted(self) -> None:
        """Power is back."""

    # -- power and time ----------------------------------------------------------------------

    def power(self, on: bool) -> None:
        """Switch the power; after it is back, everything is as at a start."""
        if on == self.is_powered:
            return
        self.is_powered = on
        if on:
            self.machine = Machine(self)
            self.server.reset(MAILBOX_BYTES)
            self._written_at = None
            self.controller.reset()
            self.restarted()
        else:
            self.outputs_off(AlCode.NONE)

    def advance(self, now: int) -> None:
        """Time passed: the watchdog, SYNC0, what is awaited on the way to OP."""
        if not self.is_powered:
            return
        self._watch(now)
        self.machine.wait(now)
        for _ in self.controller.clock.syncs(now):
            self._exchange()
        self._show()

    @property
    def is_synchronous(self) -> bool:
        """Whether SYNC0 serves the process data, not the frames."""
        return self.controller.clock.cycle_ns != 0

    def _exchange(self) -> None:
        """Serve the process data: outputs to the device, its inputs into the memory."""
        self._take_outputs()
        self._put_inputs()

    def before_frame(self) -> None:
        """A frame comes: without SYNC0 the inputs are sampled for it."""
        if self.is_powered and not self.is_synchronous:
            self._put_inputs()

    def _put_inputs(self) -> None:
        if self.machine.state >= State.SAFEOP and self._images[1].size:
            self.inputs_wanted()
            self._images[1].put(self.controller.memory, self._places[1])

    def _take_outputs(self) -> None:
        if self.machine.state is State.OP and self._images[0].size:
            self._images[0].take(self.controller.memory, self._places[0])
            self.outputs_changed()

    def _watch(self, now: int) -> None:
        """The watchdog of the outputs."""
        control = self.controller
        if self.machine.state is not State.OP or not self._images[0].size:
            return
        limit = control.get(Register.SYNC_WATCHDOG, 2) * DIVIDER_NS
        limit *= control.get(Register.WATCHDOG_DIVIDER, 2) + 2
        is_watched = control.syncs[SM_OUTPUTS].control & WATCHED and limit
        is_late = is_watched and now - (self._written_at or 0) > limit
        control.put(Register.WATCHDOG_STATUS, 0 if is_late else 1, 2)
        if is_late:
            count = control.get(Register.WATCHDOG_COUNT, 1)
            control.put(Register.WATCHDOG_COUNT, min(255, count + 1), 1)
            self.fail(State.SAFEOP, AlCode.WATCHDOG)

    def fail(self, state: State, code: AlCode) -> None:
        """Leave a state with an error, as a device does by itself."""
        if self.machine.state > state:
            self.machine.drop(state, code)
            self._show()

    def _show(self) -> None:
        self.controller.put(Register.AL_STATUS, self.machine.status, 2)
        self.controller.put(Register.AL_CODE, self.machine.code, 2)

    # -- what the controller calls -----------------------------------------------------------

    def controlled(self, control: int, now: int) -> None:
        """AL_CONTROL was written."""
        was_error = self.machine.is_error
        self.machine.request(control, now)
        if was_error and not self.machine.is_error and self.machine.state >= State.SAFEOP:
            self.controller.enable_sync(SM_OUTPUTS, True)
        self._show()

    def mailed(self, data: bytes) -> None:
        """A mail is in the mailbox of the master."""
        if self.machine.state >= State.PREOP:
            self.server.take(data)
            self.post()

    def emergency(self, code: int, register: int, data: bytes = b"") -> None:
        """Send an emergency, once the mailbox is free."""
        if self.machine.state >= State.PREOP:
            self.server.emergency(code, register, data)
            self.post()

    def post(self) -> None:
        """Put the next mail into the mailbox if there is room."""
        if self.server.outbox and not self.controller.is_full(SM_IN):
            self._last_mail = self.server.outbox.popleft()
            self._place_mail()

    def _place_mail(self) -> None:
        sync = self.controller.syncs[SM_IN]
        mail = self._last_mail[: sync.size].ljust(sync.size, b"\0")
        self.controller.memory[sync.start : sync.start + sync.size] = mail
        self.controller.set_full(SM_IN, True)

    def collected(self) -> None:
        """The master read the mail of the slave."""
        self.post()

    def asked_again(self) -> None:
        """The master wants the last mail again."""
        if self._last_mail:
            if self.controller.is_full(SM_IN):
                return
            self._place_mail()

    def outputs_written(self, now: int) -> None:
        """The outputs were written."""
        self._written_at = now
        if not self.is_synchronous:
            self._take_outputs()

    def managers_written(self) -> None:
        """A state whose sync managers the master changes or takes away is left with an error."""
        if self.machine.state >= State.SAFEOP:
            for place, code in ((0, AlCode.OUTPUT_SIZE), (1, AlCode.INPUT_SIZE)):
                sync = self.controller.syncs[SM_OUTPUTS + place]
                is_as_checked = sync.is_enabled and sync.start == self._places[place]
                size = sync.size if is_as_checked else 0
                if size != self._images[place].size:
                    self.fail(State.PREOP, code)
        if self.description.mailboxes.protocols and not self._has_mailboxes():
            self.fail(State.INIT, AlCode.MAILBOX)

    # -- transitions -------------------------------------------------------------------------

    def start_mailbox(self) -> None:
        """INIT to PREOP: the mailboxes must be as the EEPROM says, or shorter."""
        wanted = self.description.mailboxes
        if not wanted.protocols:
            return
        if not self._has_mailboxes():
            raise Refused(AlCode.MAILBOX)
        for number in (SM_OUT, SM_IN):
            self.controller.enable_sync(number, True)
        for number in (SM_OUTPUTS, SM_INPUTS):
            self.controller.enable_sync(number, False)
        self.server.reset(wanted.in_size)
        self._last_mail = b""
        self.controller.set_full(SM_OUT, False)
        self.controller.set_full(SM_IN, False)

    def _has_mailboxes(self) -> bool:
        """Whether the sync managers of the mailboxes are those of the EEPROM."""
        wanted = self.description.mailboxes
        return all(
            sync.is_enabled
            and (sync.start, sync.size) == place
            and sync.control & MODE_MASK == MAILBOX_MODE
            and sync.control & DIRECTION_MASK == direction
            for sync, place, direction in (
                (
                    self.controller.syncs[SM_OUT],
                    (wanted.out_start, wanted.out_size),
                    WRITTEN_BY_MASTER,
                ),
                (self.controller.syncs[SM_IN], (wanted.in_start, wanted.in_size), 0),
            )
        )

    def start_inputs(self) -> None:
        """PREOP to SAFEOP: the sync managers must have the length of what is mapped."""
        checks = (
            (SM_OUTPUTS, AlCode.OUTPUT_SIZE, AlCode.OUTPUT_MAPPING, WRITTEN_BY_MASTER),
            (SM_INPUTS, AlCode.INPUT_SIZE, AlCode.INPUT_MAPPING, 0),
        )
        for place, (number, wrong_size, wrong_mapping, direction) in enumerate(checks):
            try:
                image = self._mappings[place].image()
            except SdoError:
                raise Refused(wrong_mapping) from None
            sync = self.controller.syncs[number]
            if (sync.size if sync.is_enabled else 0) != image.size:
                raise Refused(wrong_size)
            if image.size and (
                sync.control & DIRECTION_MASK != direction
                or sync.control & MODE_MASK == MAILBOX_MODE
                or sync.start < self._first_free
                or sync.start + image.size > len(self.controller.memory)
            ):
                raise Refused(wrong_size)
            self._images[place] = image
            self._places[place] = sync.start
        clock = self.controller.clock
        if self.controller.memory[Register.ACTIVATION] & 2 and not clock.cycle_ns:
            raise Refused(AlCode.CLOCK_SYNC)
        for number in (SM_OUTPUTS, SM_INPUTS):
            self.controller.enable_sync(number, True)
        self._written_at = None
        self._put_inputs()

    @property
    def _first_free(self) -> int:
        """Where process data may begin: after the mailboxes."""
        ends = [self.controller.syncs[n] for n in (SM_OUT, SM_IN)]
        return max([Register.MEMORY, *(sync.start + sync.size for sync in ends if sync.size)])

    def start_outputs(self) -> bool:
        """SAFEOP to OP: once there are outputs, and SYNC0 where it is activated."""
        if self._images[0].size and self._written_at is None:
            return False
        if self.is_synchronous and not self.controller.clock.has_fired:
            return False
        self.controller.put(Register.WATCHDOG_STATUS, 1, 2)
        return True

    def missing(self) -> AlCode:
        """What was awaited in vain on the way to OP."""
        has_outputs = self._written_at is not None or not self._images[0].size
        return AlCode.NO_SYNC if has_outputs else AlCode.NO_OUTPUTS

    def stop_outputs(self, code: AlCode) -> None:
        """OP to SAFEOP: outputs are switched off; after an error they are no longer taken."""
        self.outputs_off(code)
        if code:
            self.controller.enable_sync(SM_OUTPUTS, False)
        self._written_at = None

    def stop_inputs(self) -> None:
        """SAFEOP to PREOP."""
        for number in (SM_OUTPUTS, SM_INPUTS):
            self.controller.enable_sync(number, False)

    def stop_mailbox(self) -> None:
        """PREOP to INIT."""
        self.server.reset(MAILBOX_BYTES)
        for number in (SM_OUT, SM_IN):
            self.controller.set_full(number, False)

    # -- objects that every device has -------------------------------------------------------

    def _add_identity(self) -> None:
        add, one = self.dictionary.add, self.description
        add(0x1000, Entry("Device type", DataType.UNSIGNED32, RO, self.device_type))
        self.error_register = add(0x1001, Entry("Error register", DataType.UNSIGNED8, INPUT))
        add(0x1008, Entry("Device name", DataType.VISIBLE_STRING, RO, one.name))
        add(0x1009, Entry("Hardware version", DataType.VISIBLE_STRING, RO, "emulated"))
        add(0x100A, Entry("Software version", DataType.VISIBLE_STRING, RO, "1"))
        who = one.identity
        kind = DataType.UNSIGNED32
        values = (("Vendor ID", who.vendor), ("Product code", who.product))
        more = (("Revision number", who.revision), ("Serial number", who.serial))
        identity = [Entry(name, kind, RO, value) for name, value in (*values, *more)]
        self.dictionary.add_record(0x1018, "Identity", identity)
        uses = [Entry(f"SM{n}", DataType.UNSIGNED8, RO, n + 1) for n in range(4)]
        self.dictionary.add_record(0x1C00, "Sync manager type", uses)

    device_type = 0


def describe(
    identity: sii.Identity,
    name: str,
    receive: tuple[sii.Pdo, ...],
    transmit: tuple[sii.Pdo, ...],
    alias: int = 0,
) -> sii.Description:
    """The EEPROM of a device with a mailbox and these PDOs."""
    sizes = [sum(pdo.bits for pdo in pdos if pdo.sync != 0xFF) for pdos in (receive, transmit)]
    outs, ins = ((bits + 7) // 8 for bits in sizes)
    size = MAILBOX_BYTES
    sync = (
        sii.DefaultSync(OUT_MAILBOX, size, MAILBOX_OUT_CONTROL, SyncUse.MAILBOX_OUT),
        sii.DefaultSync(IN_MAILBOX, size, MAILBOX_IN_CONTROL, SyncUse.MAILBOX_IN),
        sii.DefaultSync(OUTPUTS, outs, OUTPUTS_CONTROL, SyncUse.OUTPUTS, bool(outs)),
        sii.DefaultSync(INPUTS, ins, INPUTS_CONTROL, SyncUse.INPUTS, bool(ins)),
    )
    return sii.Description(
        identity,
        alias,
        sii.Mailboxes(OUT_MAILBOX, size, IN_MAILBOX, size, Protocol.COE),
        name=name,
        order=name,
        group="openacr emulated",
        coe_details=COE_DETAILS,
        fmmu=(1, 2, 3, 0),
        sync=sync,
        receive=receive,
        transmit=transmit,
    )


__all__ = ["INPUT", "OUTPUT", "VENDOR", "Slave", "describe"]
