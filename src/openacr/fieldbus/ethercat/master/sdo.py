"""Objects of a device by mail (SDO)."""

import logging
from collections.abc import Iterator
from contextlib import suppress

from openacr.fieldbus.ethercat.master.device import Device
from openacr.fieldbus.ethercat.master.port import BusError
from openacr.fieldbus.ethercat.wire import coe, managers
from openacr.fieldbus.ethercat.wire.frames import WireError
from openacr.fieldbus.ethercat.wire.mailbox import (
    HEADER_SIZE,
    Mail,
    MailType,
    Protocol,
    next_counter,
)
from openacr.fieldbus.ethercat.wire.registers import Register

log = logging.getLogger(__name__)
ANSWER_S = 2.0
POLL_S = 0.0005


class SdoError(BusError):
    """The device has refused an access to an object."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


class Objects:
    """The object dictionary of a device that is at least in PREOP."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._boxes = device.description.mailboxes
        self._counter = 0
        if not self._boxes.protocols & Protocol.COE:
            raise BusError(f"{device.label} has no object dictionary (CoE)")

    def read(self, index: int, subindex: int = 0) -> bytes:
        """The bytes of an object; SdoError if the device refuses, BusError without an answer."""
        reply = self._call(coe.Upload(index, subindex), index, subindex)
        if not isinstance(reply, coe.Uploaded):
            raise self._strange(index, subindex)
        data, toggle = reply.data, False
        while len(data) < reply.size:
            part = self._call(coe.UploadNext(toggle), index, subindex)
            if not isinstance(part, coe.Segment) or part.toggle is not toggle:
                raise self._strange(index, subindex)
            data, toggle = data + part.data, not toggle
            if part.is_last:
                break
        return data

    def number(self, index: int, subindex: int = 0, *, is_signed: bool = False) -> int:
        """The value of an object that is a whole number."""
        return int.from_bytes(self.read(index, subindex), "little", signed=is_signed)

    def write(self, index: int, subindex: int, data: bytes) -> None:
        """Write an object; SdoError if the device refuses, BusError without an answer."""
        room = self._boxes.out_size - HEADER_SIZE - coe.SDO_HEAD
        first = data if len(data) <= max(room, coe.EXPEDITED) else data[:room]
        reply = self._call(coe.Download(index, subindex, first, len(data)), index, subindex)
        if not isinstance(reply, coe.Downloaded):
            raise self._strange(index, subindex)
        toggle, rest = False, data[len(first) :]
        size = self._boxes.out_size - HEADER_SIZE - coe.SEGMENT_HEAD
        while rest:
            part, rest = rest[:size], rest[size:]
            answer = self._call(coe.DownloadNext(toggle, part, not rest), index, subindex)
            if not isinstance(answer, coe.DownloadedNext):
                raise self._strange(index, subindex)
            toggle = not toggle

    def _call(self, request: coe.Request, index: int, subindex: int) -> coe.Reply:
        self._send(request.pack())
        for body in self._answers():
            reply = coe.parse_reply(body)
            if isinstance(reply, coe.Aborted):
                text = f"{self.device.label}: object 0x{index:04X}:{subindex}: {reply.text}"
                raise SdoError(text, reply.code)
            if isinstance(reply, coe.Uploaded | coe.Downloaded):
                if (reply.index, reply.subindex) != (index, subindex):
                    continue  # of an earlier request
            return reply
        raise BusError(
            f"{self.device.label}: object 0x{index:04X}:{subindex}: no answer in {ANSWER_S:g} s"
        )

    def _send(self, payload: bytes) -> None:
        with suppress(StopIteration):
            next(self._mails(0.0))  # what is left of an earlier request
        # The first mail has no counter: it is never taken for a repeated one of another master.
        mail = Mail(MailType.COE, payload, self._counter).pack()
        self._counter = next_counter(self._counter)
        port, size = self.device.port, self._boxes.out_size
        if len(mail) > size:
            raise BusError(f"{self.device.label}: a mail of {len(mail)} bytes, room for {size}")
        # The device takes the mail when the last byte of the mailbox is written.
        port.write(self.device.station, self._boxes.out_start, mail.ljust(size, b"\0"))

    def _answers(self) -> Iterator[bytes]:
        """The bodies of SDO responses; emergencies are noted."""
        for mail in self._mails(ANSWER_S):
            if mail.kind != MailType.COE:
                continue
            service, body = coe.service_of(mail.payload)
            if service == coe.Service.EMERGENCY:
                emergency = coe.Emergency.parse(body)
                log.warning("%s: emergency 0x%04X", self.device.label, emergency.code)
            elif service in (coe.Service.RESPONSE, coe.Service.REQUEST):
                yield body  # an abort is sent as a request

    def _mails(self, patience_s: float) -> Iterator[Mail]:
        """The mails that arrive within a time."""
        port, station = self.device.port, self.device.station
        status = Register.SYNC + managers.SYNC_SIZE + managers.STATUS_PLACE
        deadline_s = port.link.now_s() + patience_s
        while True:
            if port.read(station, status, 1)[0] & managers.FULL:
                data = port.read(station, self._boxes.in_start, self._boxes.in_size)
                with suppress(WireError):
                    yield Mail.parse(data)
            if port.link.now_s() >= deadline_s:
                return
            port.link.pause(POLL_S)

    def _strange(self, index: int, subindex: int) -> BusError:
        return BusError(
            f"{self.device.label}: object 0x{index:04X}:{subindex}: an answer to something else"
        )
