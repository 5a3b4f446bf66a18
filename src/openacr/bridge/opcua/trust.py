"""Which hosts are trusted by their certificates: those in a folder, and those they have signed.

Revocation lists in the folder take certificates out again.
"""

import logging
from pathlib import Path

from cryptography import x509
from cryptography.exceptions import InvalidSignature

from openacr.bridge.clock import now
from openacr.errors import UserError, read_bytes, reason

log = logging.getLogger(__name__)
ENDINGS = (".pem", ".crt", ".cer", ".der")
LIST_ENDING = ".crl"


class Trusted:
    """The certificates of a folder as they are at the start; UserError where it has none."""

    def __init__(self, folder: Path) -> None:
        try:
            files = sorted(folder.iterdir())
        except OSError as error:
            raise UserError(f"opcua.trusted: {folder}: {reason(error)}") from None
        paths = [path for path in files if path.suffix.lower() in ENDINGS]
        if not paths:
            raise UserError(
                f"opcua.trusted: {folder} has no certificate ({', '.join(ENDINGS)}):"
                " no host could connect"
            )
        self._known = [_read(path) for path in paths]
        lists = [path for path in files if path.suffix.lower() == LIST_ENDING]
        self._revoked = [_read_list(path, self._known) for path in lists]

    def admits(self, data: object) -> bool:
        """Whether the holder of a certificate in DER is trusted now; why not is in the log."""
        why = self._refusal(data)
        if why:
            log.warning("opcua: a host is refused: %s", why)
        return not why

    def _refusal(self, data: object) -> str:
        try:
            found = x509.load_der_x509_certificate(data if isinstance(data, bytes) else b"")
        except ValueError:
            return "it shows no certificate that can be read"
        name = found.subject.rfc4514_string() or "a certificate without a name"
        if not found.not_valid_before_utc <= now() <= found.not_valid_after_utc:
            return f"{name} is not valid at this time"
        if any(_revokes(each, found) for each in self._revoked):
            return f"{name} is revoked"
        is_known = any(each == found or _has_signed(each, found) for each in self._known)
        return "" if is_known else f"{name} is not among the trusted ones"


def _read(path: Path) -> x509.Certificate:
    """A certificate in PEM or DER; UserError for anything else."""
    data = read_bytes(path)
    is_pem = b"-----BEGIN" in data
    load = x509.load_pem_x509_certificate if is_pem else x509.load_der_x509_certificate
    try:
        return load(data)
    except ValueError:
        raise UserError(f"opcua.trusted: {path} is no certificate in PEM or DER") from None


def _read_list(path: Path, known: list[x509.Certificate]) -> x509.CertificateRevocationList:
    """A revocation list in PEM or DER of one of the known authorities; UserError for others."""
    data = read_bytes(path)
    is_pem = b"-----BEGIN" in data
    load = x509.load_pem_x509_crl if is_pem else x509.load_der_x509_crl
    try:
        found = load(data)
    except ValueError:
        raise UserError(f"opcua.trusted: {path} is no revocation list in PEM or DER") from None
    if not any(_has_issued(each, found) for each in known):
        raise UserError(
            f"opcua.trusted: {path} is signed by none of the certificates of the folder:"
            " put the certificate of its authority there"
        )
    return found


def _has_issued(authority: x509.Certificate, found: x509.CertificateRevocationList) -> bool:
    """Whether an authority has signed a revocation list."""
    try:
        is_signed = found.is_signature_valid(authority.public_key())  # type: ignore[arg-type]
    except TypeError:  # its key signs no lists
        return False
    return is_signed and found.issuer == authority.subject


def _revokes(found: x509.CertificateRevocationList, certificate: x509.Certificate) -> bool:
    """Whether a list has a certificate, one that is out of date as well."""
    listed = found.get_revoked_certificate_by_serial_number(certificate.serial_number)
    return listed is not None and found.issuer == certificate.issuer


def _has_signed(authority: x509.Certificate, found: x509.Certificate) -> bool:
    """Whether an authority, valid now, has signed a certificate itself."""
    try:
        limits = authority.extensions.get_extension_for_class(x509.BasicConstraints).value
        found.verify_directly_issued_by(authority)
    except (x509.ExtensionNotFound, InvalidSignature, TypeError, ValueError):
        return False
    return limits.ca and authority.not_valid_before_utc <= now() <= authority.not_valid_after_utc
