"""The mailbox side of a slave: SDOs, information about objects, emergencies."""

from collections import deque
from collections.abc import Callable

from openacr.fieldbus.ethercat.emulated.dictionary import Access, Dictionary, SdoError
from openacr.fieldbus.ethercat.wire import coe, sdo_info
from openacr.fieldbus.ethercat.wire.coe import Abort, Service
from openacr.fieldbus.ethercat.wire.frames import WireError
from openacr.fieldbus.ethercat.wire.mailbox import (
    HEADER_SIZE,
    Mail,
    MailError,
    MailType,
    error_mail,
    next_counter,
)
from openacr.fieldbus.ethercat.wire.registers import State
from openacr.fieldbus.ethercat.wire.sdo_info import Information, ListKind, Question

LONGEST_OBJECT = 1 << 16


class SdoServer:
    """Takes mails of the master, and has the answers in `outbox`, packed."""

    def __init__(self, dictionary: Dictionary, state: Callable[[], State]) -> None:
        self._dictionary = dictionary
        self._state = state
        self.outbox: deque[bytes] = deque()
        self.reset(128)

    def reset(self, size: int) -> None:
        """Forget everything; the mailboxes have `size` bytes from now on."""
        self.outbox.clear()
        self._room = size - HEADER_SIZE
        self._counter = 0
        self._seen = 0
        self._abandon()

    def _abandon(self) -> None:
        self._left = b""  # of an upload
        self._taken = bytearray()  # of a download
        self._open: coe.Download | None = None
        self._toggle = False

    def take(self, data: bytes) -> None:
        """A mail arrived; one with the number of the last is a repetition and left out."""
        try:
            mail = Mail.parse(data)
        except WireError:
            self._send(error_mail(MailError.SIZE, 0))
            return
        if mail.counter and mail.counter == self._seen:
            return
        self._seen = mail.counter
        if mail.kind != MailType.COE:
            self._send(error_mail(MailError.PROTOCOL, 0))
            return
        try:
            service, body = coe.service_of(mail.payload)
            if service == Service.INFORMATION:
                self._inform(Information.parse(body))
            elif service == Service.REQUEST:
                self._serve(coe.parse_request(body))
            else:
                self._send(error_mail(MailError.SERVICE, 0))
        except WireError:
            self._send(error_mail(MailError.TOO_SHORT, 0))

    def emergency(self, code: int, register: int, data: bytes = b"") -> None:
        """Send an emergency."""
        self._post(coe.Emergency(code, register, data).pack())

    # -- SDO ---------------------------------------------------------------------------------

    def _serve(self, request: coe.Request) -> None:
        index, subindex = 0, 0
        if isinstance(request, coe.Upload | coe.Download):
            self._abandon()
            index, subindex = request.index, request.subindex
        elif self._open is not None:
            index, subindex = self._open.index, self._open.subindex
        try:
            if isinstance(request, coe.Upload):
                self._upload(request)
            elif isinstance(request, coe.UploadNext):
                self._upload_next(request)
            elif isinstance(request, coe.Download):
                self._download(request)
            elif isinstance(request, coe.DownloadNext):
                self._download_next(request)
            else:
                self._abandon()
        except SdoError as refused:
            self._abandon()
            self._post(coe.Aborted(index, subindex, refused.code).pack())

    def _upload(self, asked: coe.Upload) -> None:
        data = self._dictionary.read(asked.index, asked.subindex, asked.complete)
        room = self._room - coe.SDO_HEAD
        first, self._left = data[:room], data[room:]
        self._post(
            coe.Uploaded(asked.index, asked.subindex, first, len(data), asked.complete).pack()
        )

    def _upload_next(self, asked: coe.UploadNext) -> None:
        if not self._left:
            raise SdoError(Abort.COMMAND)
        self._turn(asked.toggle)
        room = self._room - coe.SEGMENT_HEAD
        part, self._left = self._left[:room], self._left[room:]
        self._post(coe.Segment(asked.toggle, part, not self._left).pack())

    def _download(self, asked: coe.Download) -> None:
        if asked.size > LONGEST_OBJECT:
            raise SdoError(Abort.NO_MEMORY)
        if len(asked.data) >= asked.size:
            self._write(asked, asked.data)
        else:
            self._dictionary.object(asked.index)
            self._open, self._taken = asked, bytearray(asked.data)
        self._post(coe.Downloaded(asked.index, asked.subindex, asked.complete).pack())

    def _download_next(self, asked: coe.DownloadNext) -> None:
        if self._open is None:
            raise SdoError(Abort.COMMAND)
        self._turn(asked.toggle)
        self._taken += asked.data
        if len(self._taken) > self._open.size:
            raise SdoError(Abort.TOO_LONG)
        if asked.is_last:
            if len(self._taken) < self._open.size:
                raise SdoError(Abort.TOO_SHORT)
            self._write(self._open, bytes(self._taken))
            self._open = None
        self._post(coe.DownloadedNext(asked.toggle).pack())

    def _write(self, asked: coe.Download, data: bytes) -> None:
        self._dictionary.write(asked.index, asked.subindex, data, asked.complete, self._state())

    def _turn(self, toggle: bool) -> None:
        if toggle != self._toggle:
            raise SdoError(Abort.TOGGLE)
        self._toggle = not toggle

    # -- information -------------------------------------------------------------------------

    def _inform(self, asked: Information) -> None:
        try:
            data = self._description(asked)
        except SdoError as refused:
            code = int(refused.code).to_bytes(4, "little")
            self._post(Information(Question.ERROR, code).pack())
            return
        room = self._room - coe.COE_SIZE - sdo_info.HEAD_SIZE
        parts = [data[place : place + room] for place in range(0, len(data), room)]
        for number, part in enumerate(parts, 1):
            self._post(Information(asked.operation + 1, part, len(parts) - number).pack())

    def _description(self, asked: Information) -> bytes:
        words = sdo_info.words_of(asked.data)
        if asked.operation == Question.LIST and words:
            return self._list(words[0])
        if asked.operation == Question.OBJECT and words:
            one = self._dictionary.object(words[0])
            return sdo_info.ObjectDescription(
                words[0], one.kind, max(one.entries), one.code, one.name
            ).pack()
        if asked.operation == Question.ENTRY and len(words) > 1:
            subindex = words[1] & 0xFF
            entry = self._dictionary.entry(words[0], subindex)
            return sdo_info.EntryDescription(
                words[0], subindex, entry.kind, entry.bits, entry.access, entry.name
            ).pack()
        raise SdoError(Abort.COMMAND)

    def _list(self, kind: int) -> bytes:
        wanted = {
            ListKind.ALL: Access.READ,
            ListKind.RECEIVE: Access.RECEIVE,
            ListKind.TRANSMIT: Access.TRANSMIT,
        }
        found = {
            one: [
                index
                for index, each in sorted(self._dictionary.objects.items())
                if any(entry.access & access for entry in each.entries.values())
            ]
            for one, access in wanted.items()
        }
        if kind == ListKind.COUNTS:
            numbers = [len(found.get(one, [])) for one in list(ListKind)[1:]]
        elif kind in list(ListKind):
            numbers = found.get(ListKind(kind), [])
        else:
            raise SdoError(Abort.RANGE)
        return b"".join(number.to_bytes(2, "little") for number in (kind, *numbers))

    # -- sending -----------------------------------------------------------------------------

    def _post(self, payload: bytes) -> None:
        self._send(Mail(MailType.COE, payload))

    def _send(self, mail: Mail) -> None:
        self._counter = next_counter(self._counter)
        numbered = Mail(mail.kind, mail.payload, self._counter, mail.address)
        self.outbox.append(numbered.pack())
