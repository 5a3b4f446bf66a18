"""The connection to the broker: its encryption, why it fails, and its proper end."""

import logging
import ssl
from pathlib import Path

import paho.mqtt.client as mqtt

from openacr.bridge.settings import Sparkplug
from openacr.errors import UserError, reason

log = logging.getLogger(__name__)
GOODBYE_S = 2.0


def failure(place: str, error: BaseException | None) -> str:
    """Why a broker cannot be connected to."""
    if isinstance(error, ssl.SSLCertVerificationError):
        return f"the certificate of {place} is refused: {error.verify_message.rstrip('.')}"
    if isinstance(error, ssl.SSLError):
        return f"TLS with {place} has failed: {error.reason or error}"
    return f"{place} does not answer"


def part(client: mqtt.Client, topic: str, death: bytes) -> None:
    """Publish the death and end the connection: the broker sends no will after a proper end."""
    if client.is_connected():
        try:
            client.publish(topic, death, qos=1).wait_for_publish(GOODBYE_S)
        except (RuntimeError, ValueError):
            log.info("sparkplug: the broker has gone before the goodbye")
    client.disconnect()
    client.loop_stop()


def encryption(settings: Sparkplug, folder: Path) -> ssl.SSLContext:
    """TLS with the authority and the certificate of the file."""
    names = (settings.authority, settings.certificate, settings.private_key)
    authority, certificate, key = (None if name is None else folder / name for name in names)
    try:
        context = ssl.create_default_context(cafile=authority)
        if certificate is not None:
            context.load_cert_chain(certificate, key)
    except (OSError, ValueError) as error:
        raise UserError(f"sparkplug: the certificates cannot be used: {reason(error)}") from None
    context.sslsocket_class = _Socket
    return context


class _Socket(ssl.SSLSocket):
    """A socket that is closed where its handshake fails: paho leaves it open."""

    def do_handshake(self, block: bool = False) -> None:
        """Agree with the broker on keys."""
        try:
            super().do_handshake(block)
        except OSError:
            self.close()
            raise
