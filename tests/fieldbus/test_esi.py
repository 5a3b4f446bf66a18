"""Descriptions of devices by their makers: what is read of them, and how a scan uses them."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.fieldbus.bus_rig import SegmentLink
from typer.testing import CliRunner

from openacr.cli import bus
from openacr.cli.main import app
from openacr.errors import UserError
from openacr.fieldbus.ethercat.emulated.build import drives_world, segment_of
from openacr.fieldbus.ethercat.master.device import Device, scan
from openacr.fieldbus.ethercat.master.esi import described, read_esi
from openacr.fieldbus.ethercat.master.port import Port
from openacr.fieldbus.ethercat.wire.sii import Identity

DEVICE = """
<Device>
  <Type ProductCode="#x00000402" RevisionNo="{revision}">DRV-1</Type>
  <Name LcId="1031">Antrieb</Name>
  <Name LcId="1033">Drive {revision}</Name>
  <RxPdo Fixed="1" Sm="2"><Index>#x1600</Index><Name>Position</Name>
    <Entry><Index>#x6040</Index><SubIndex>0</SubIndex><BitLen>16</BitLen><Name>Control</Name></Entry>
    <Entry><Index>0</Index><BitLen>8</BitLen></Entry>
  </RxPdo>
  <RxPdo><Index>#x1601</Index><Name>Speed</Name></RxPdo>
  <TxPdo Sm="3"><Index>#x1A00</Index><Name>State</Name>
    <Entry><Index>#x6041</Index><BitLen>16</BitLen><Name>Status</Name></Entry>
  </TxPdo>
</Device>
"""


def esi(folder: Path, devices: str, vendor: str = "#xAC2") -> Path:
    path = folder / "maker.xml"
    path.write_text(
        f"<EtherCATInfo><Vendor><Id>{vendor}</Id><Name>Maker</Name></Vendor>"
        f"<Descriptions><Devices>{devices}</Devices></Descriptions></EtherCATInfo>"
    )
    return path


def test_names_and_pdos_with_their_objects_are_read(tmp_path: Path) -> None:
    (one,) = read_esi(esi(tmp_path, DEVICE.format(revision=1), vendor="2754"))
    assert (one.who, one.name, one.maker) == (Identity(0xAC2, 0x402, 1), "Drive 1", "Maker")
    assert [(pdo.index, pdo.name, pdo.sync, pdo.is_fixed) for pdo in one.receive] == [
        (0x1600, "Position", 2, True),
        (0x1601, "Speed", 0xFF, False),
    ]
    entry = one.receive[0].entries[0]
    assert (entry.index, entry.subindex, entry.bits, entry.name) == (0x6040, 0, 16, "Control")
    assert [pdo.index for pdo in one.transmit] == [0x1A00]


def test_the_revision_of_a_device_is_taken_else_the_newest_of_its_product(tmp_path: Path) -> None:
    texts = "".join(DEVICE.format(revision=number) for number in (1, 3, 2))
    files = read_esi(esi(tmp_path, texts))

    def name(*who: int) -> str | None:
        found = described(Identity(*who), files)
        return None if found is None else found.name

    assert name(0xAC2, 0x402, 1) == "Drive 1"
    assert name(0xAC2, 0x402, 9) == "Drive 3"
    assert name(0xAC2, 0x403, 1) is None
    assert name(0xAC3, 0x402, 1) is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<EtherCATInfo>", "not XML"),
        ("<Other/>", "begins with Other, not EtherCATInfo"),
        ("<EtherCATInfo><Vendor><Id>x</Id></Vendor></EtherCATInfo>", "Vendor/Id is 'x'"),
    ],
)
def test_what_is_no_such_file_is_named(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "bad.xml"
    path.write_text(text)
    with pytest.raises(UserError, match=said):
        read_esi(path)
    with pytest.raises(UserError, match=r"none\.xml"):
        read_esi(tmp_path / "none.xml")


@pytest.fixture
def scanned(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bus of a drive and a terminal in the place of an interface."""

    @contextmanager
    def found(_interface: str) -> Iterator[list[Device]]:
        yield scan(Port(SegmentLink(segment_of(drives_world(1), digital=1))))

    monkeypatch.setattr(bus, "open_bus", found)


@pytest.mark.usefixtures("scanned")
def test_a_scan_with_a_description_lists_pdos_and_refuses_an_unknown_device_with_its_objects(
    tmp_path: Path,
) -> None:
    path = esi(tmp_path, DEVICE.format(revision=1))
    wanted = tmp_path / "machine.toml"
    result = CliRunner().invoke(
        app, ["bus", "scan", "eth9", "--esi", str(path), "--write", str(wanted)]
    )
    assert "   Maker Drive 1\n" in result.output
    assert "   outputs 0x1600 Position, assigned: 0x6040:0 Control (16 bits)\n" in result.output
    assert "   outputs 0x1601 Speed: \n" in result.output
    assert "   inputs 0x1A00 Input, assigned: 0x6000:1 Input 1 (1 bits)" in result.output
    assert result.exit_code == 2
    assert "device 1 (digital) (vendor 0xAC2 product 0xD100808): not in the ESI" in result.output
    assert not wanted.exists()


@pytest.mark.usefixtures("scanned")
def test_devices_that_are_all_described_are_written(tmp_path: Path) -> None:
    other = DEVICE.format(revision=1).replace("#x00000402", "#xD100808")
    path = esi(tmp_path, DEVICE.format(revision=7) + other)
    wanted = tmp_path / "machine.toml"
    result = CliRunner().invoke(
        app, ["bus", "scan", "eth9", "--esi", str(path), "--write", str(wanted)]
    )
    assert result.exit_code == 0
    assert "   Maker Drive 7, as of revision 0x7\n" in result.output
    assert "[axis.bus]" in wanted.read_text()
