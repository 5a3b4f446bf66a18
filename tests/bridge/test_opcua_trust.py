"""Trusted certificates: in the folder, signed by one in it, and all that is refused."""

from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from cryptography import x509
from cryptography.hazmat.primitives.asymmetric.x25519 import X25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding
from tests.bridge.authority import DAY, Authority, _named

from openacr.bridge.clock import now
from openacr.bridge.load import parse_bridge
from openacr.bridge.opcua import trust
from openacr.bridge.opcua.trust import Trusted
from openacr.errors import SourceError, UserError


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An authority in PEM, and the certificate of one host in DER."""
    made = tmp_path / "trusted"
    made.mkdir()
    Authority(made, "authority")
    (made / "host.DER").write_bytes(host(tmp_path, "alone"))
    (made / "readme.txt").write_text("no certificate")
    return made


def host(folder: Path, name: str, *, signed_by: Authority | None = None) -> bytes:
    """The certificate of a host, in DER."""
    place = folder / name
    place.mkdir(exist_ok=True)
    paths = (signed_by or Authority(place, name)).server("192.0.2.7")
    return der(paths[0])


def der(path: Path) -> bytes:
    return x509.load_pem_x509_certificate(path.read_bytes()).public_bytes(Encoding.DER)


def test_hosts_of_the_folder_and_those_its_authorities_have_signed_are_trusted(
    folder: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    authority = Authority(folder, "authority")
    trusted = Trusted(folder)
    assert trusted.admits(host(tmp_path, "any", signed_by=authority))
    assert trusted.admits(der(folder / "authority.pem"))
    assert trusted.admits((folder / "host.DER").read_bytes())
    assert caplog.messages == []
    Authority(tmp_path, "authority")  # of the same name, with another key
    assert not trusted.admits(host(tmp_path, "alone"))
    assert not trusted.admits(der(tmp_path / "authority.pem"))
    assert not trusted.admits(None)
    assert not trusted.admits(b"\x30\x00")
    refused = "opcua: a host is refused: "
    assert caplog.messages == [
        f"{refused}CN=192.0.2.7 is not among the trusted ones",
        f"{refused}CN=authority is not among the trusted ones",
        f"{refused}it shows no certificate that can be read",
        f"{refused}it shows no certificate that can be read",
    ]


@pytest.mark.parametrize("is_pem", [True, False])
def test_a_host_on_a_revocation_list_of_its_authority_is_refused(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, is_pem: bool
) -> None:
    folder = tmp_path / "trusted"
    folder.mkdir()
    (tmp_path / "made").mkdir()
    authority, other = (Authority(tmp_path / "made", name) for name in ("authority", "other"))
    first, second, third = (host(tmp_path, "any", signed_by=authority) for _ in range(3))
    foreign = host(tmp_path, "any", signed_by=other)
    for each in (authority, other):
        each.pem.rename(folder / each.pem.name)
    (folder / "second.der").write_bytes(second)  # it is there, but its authority takes it back
    numbers = [x509.load_der_x509_certificate(d).serial_number for d in (first, second, foreign)]
    found = authority.revocation_list(*numbers)  # an authority speaks of its own ones alone
    if not is_pem:
        found = x509.load_pem_x509_crl(found).public_bytes(Encoding.DER)
    (folder / "a.CRL").write_bytes(found)
    (folder / "b.crl").write_bytes(other.revocation_list())
    trusted = Trusted(folder)
    admitted = [trusted.admits(each) for each in (first, second, third, foreign)]
    assert admitted == [False, False, True, True]
    assert caplog.messages == ["opcua: a host is refused: CN=192.0.2.7 is revoked"] * 2


def test_a_revocation_list_is_that_of_an_authority_in_the_folder(
    folder: Path, tmp_path: Path
) -> None:
    same_name = Authority(tmp_path, "authority")  # with another key
    (folder / "a.crl").write_bytes(same_name.revocation_list())
    with pytest.raises(UserError, match=r"a\.crl is signed by none of the certificates of the"):
        Trusted(folder)
    same_key = Authority(tmp_path, "stranger")
    same_key._key = Authority(folder, "authority")._key
    (folder / "a.crl").write_bytes(same_key.revocation_list())
    with pytest.raises(UserError, match=r"a\.crl is signed by none of the certificates of the"):
        Trusted(folder)
    (folder / "a.crl").write_text("no list")
    with pytest.raises(UserError, match=r"a\.crl is no revocation list in PEM or DER"):
        Trusted(folder)


def test_a_certificate_whose_key_signs_nothing_is_no_hindrance_to_a_list(tmp_path: Path) -> None:
    authority = Authority(tmp_path, "authority")
    exchanging: Any = X25519PrivateKey.generate()
    (tmp_path / "a.pem").write_bytes(authority._signed(_named("a"), exchanging))
    (tmp_path / "a.crl").write_bytes(authority.revocation_list())
    assert Trusted(tmp_path).admits(der(tmp_path / "authority.pem"))


def test_a_host_does_not_sign_for_others(tmp_path: Path) -> None:
    """A certificate in the folder that is no authority admits itself alone."""
    (tmp_path / "trusted").mkdir()
    authority = Authority(tmp_path, "authority", is_authority=False)
    authority.pem.rename(tmp_path / "trusted" / "authority.pem")
    assert not Trusted(tmp_path / "trusted").admits(host(tmp_path, "any", signed_by=authority))


@pytest.mark.parametrize(
    ("late", "is_trusted"),
    [
        (timedelta(0), True), (DAY - timedelta(minutes=1), True), (DAY, False),
        (timedelta(minutes=1) - DAY, True), (-DAY - timedelta(minutes=1), False),
    ],
)  # fmt: skip
def test_certificates_are_trusted_within_their_dates(
    folder: Path, monkeypatch: pytest.MonkeyPatch, late: timedelta, is_trusted: bool
) -> None:
    trusted, time = Trusted(folder), now() + late
    monkeypatch.setattr(trust, "now", lambda: time + timedelta(seconds=30))
    assert trusted.admits((folder / "host.DER").read_bytes()) is is_trusted


def test_an_authority_whose_time_is_over_admits_no_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "trusted").mkdir()
    authority = Authority(tmp_path / "trusted", "authority", lasts=timedelta(hours=2))
    trusted, signed = Trusted(tmp_path / "trusted"), host(tmp_path, "any", signed_by=authority)
    assert trusted.admits(signed)
    time = now() + timedelta(hours=3)
    monkeypatch.setattr(trust, "now", lambda: time)
    assert not trusted.admits(signed)


def test_a_folder_that_admits_none_is_said(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"opcua\.trusted: .*missing: "):
        Trusted(tmp_path / "missing")
    with pytest.raises(UserError, match=r"has no certificate \(\.pem, \.crt, \.cer, \.der\)"):
        Trusted(tmp_path)
    (tmp_path / "a.crt").write_text("no certificate")
    with pytest.raises(UserError, match=r"a\.crt is no certificate in PEM or DER"):
        Trusted(tmp_path)


def test_trusted_hosts_need_a_server_with_a_certificate() -> None:
    with pytest.raises(SourceError, match=r"opcua\.trusted: hosts show certificates only to"):
        parse_bridge('[opcua]\ntrusted = "hosts"\n')
