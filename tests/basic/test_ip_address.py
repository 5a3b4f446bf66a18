"""Addresses of the network."""

import pytest
from tests.basic.machine import Machine
from typer.testing import CliRunner

from openacr.basic.memory.ip_address import IpAddress
from openacr.cli.main import app


def explained(*arguments: str) -> list[str]:
    ended = CliRunner().invoke(app, ["ip", *arguments])
    return (ended.stdout + ended.stderr).splitlines()


@pytest.mark.req("ACR-IP-04")
@pytest.mark.parametrize("text", ["192.168.0.0", "192.168.10.255", "255.255.255.255"])
def test_networks_and_broadcasts_are_no_hosts(text: str) -> None:
    bench = Machine()
    assert bench.type(f'IP "{text}"') == "Invalid argument|SYS>"
    assert bench.type("IP").startswith("IP 192.168.10.40|")
    assert "no card can have it: its host part is zero, or an octet is 255" in explained(text)


@pytest.mark.req("ACR-IP-05")
@pytest.mark.parametrize(
    ("first", "found"),
    [(0, "A, 8"), (127, "A, 8"), (128, "B, 16"), (191, "B, 16"), (192, "C, 24"), (223, "C, 24")],
)
def test_the_first_octet_tells_the_class(first: int, found: str) -> None:
    assert explained(f"{first}.1.2.3")[0].startswith(f"{first}.1.2.3: class {found} network bits")


def test_addresses_above_are_no_hosts() -> None:
    assert IpAddress.read("224.0.0.1").network_class is None


@pytest.mark.req("ACR-IP-06")
@pytest.mark.parametrize(
    ("text", "is_private"),
    [
        ("10.0.0.0", True), ("10.255.255.255", True), ("9.255.255.255", False), ("11.0.0.0", False),
        ("172.16.0.0", True), ("172.31.255.255", True), ("172.15.255.255", False),
        ("172.32.0.0", False), ("192.168.0.0", True), ("192.168.255.255", True),
        ("192.167.255.255", False), ("192.169.0.0", False),
    ],
)  # fmt: skip
def test_private_ranges_are_known(text: str, is_private: bool) -> None:
    assert IpAddress.read(text).is_private is is_private
    assert explained(text)[0].endswith("private" if is_private else "public")


@pytest.mark.req("ACR-IP-07")
def test_mask_and_address_give_network_and_host() -> None:
    assert explained("172.20.44.180")[1] == "network 172.20.44, host 180 (mask 255.255.255.0)"
    assert explained("172.20.44.180", "--mask", "255.255.0.0")[1].startswith(
        "network 172.20, host 11444"
    )
    assert IpAddress.read("10.1.2.200").host(IpAddress.read("255.255.255.192")) == 8


@pytest.mark.req("ACR-IP-08")
def test_different_networks_need_a_router() -> None:
    assert explained("192.168.10.40", "--host", "192.168.5.7")[2] == (
        "192.168.5.7 is in network 192.168.5: a router has to be between them"
    )
    assert explained("192.168.10.40", "--host", "192.168.10.7")[2] == (
        "192.168.10.7 is in the same network"
    )
    assert explained("192.168.10.40", "--host", "7")[-1] == (
        "error: 7: an address has four numbers from 0 to 255"
    )


@pytest.mark.parametrize(
    ("mask", "is_mask"),
    [("255.255.255.0", True), ("255.255.252.0", True), ("0.0.0.0", True), ("255.0.255.0", False)],
)
def test_a_mask_is_ones_before_zeros(mask: str, is_mask: bool) -> None:
    ended = CliRunner().invoke(app, ["ip", "10.1.2.3", "--mask", mask])
    assert (ended.exit_code, "ones before zeros" in ended.stderr) == (
        (0, False) if is_mask else (2, True)
    )
