"""A channel joined with another one (TALK TO) or with a drive (DTALK), until ESC."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.channels import EchoMode
from openacr.errors import CardError
from openacr.messages import DEVICE_IN_USE
from openacr.network.drivetalk import lines

if TYPE_CHECKING:
    from openacr.basic.channels.session import Session


def join_channel(session: Session, other: Session) -> None:
    """TALK TO: what is typed on one channel leaves on the other."""
    if other.opened_by is not None or other.is_joined:
        raise CardError(DEVICE_IN_USE)
    session.partner, other.partner = other.name, session.name
    session.has_called = True


def join_drive(session: Session, axis: int, port: int) -> None:
    """DTALK: what is typed goes to the drive of an axis, over a Drive Talk line."""
    lines.connect(session.system.card.memory, port, session.index, axis)
    session.drive = axis


def type_byte(session: Session, byte: int) -> None:
    """One byte typed on a joined channel."""
    if session.drive is not None:
        shown = lines.type_byte(session.system.card.memory, session.index, byte)
        if session.echo & EchoMode.CHARACTERS:
            session.write(shown)
    elif session.partner is not None:
        session.system.sessions[session.partner].write(chr(byte))


def leave(session: Session) -> None:
    """End it from this side; the line on the other side that has begun it is answered now."""
    if session.drive is not None:
        lines.disconnect(session.system.card.memory, session.index)
    if session.partner is not None:
        other = session.system.sessions[session.partner]
        if other.has_called:
            other.end_mode()
        other.partner, other.has_called = None, False
    session.drive, session.partner, session.has_called = None, None, False
