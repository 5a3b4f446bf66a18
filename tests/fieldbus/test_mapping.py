"""Process data of drives that do not take everything into one PDO."""

from dataclasses import replace

import pytest
from tests.fieldbus.bus_rig import SegmentLink

from openacr.fieldbus.cia402 import objects as of
from openacr.fieldbus.ethercat.emulated import pdo
from openacr.fieldbus.ethercat.emulated.build import drives_world
from openacr.fieldbus.ethercat.emulated.drive import Drive
from openacr.fieldbus.ethercat.emulated.drive_objects import I8, I32, U16, drive_description
from openacr.fieldbus.ethercat.emulated.motor import Motor, Plant
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.ethercat.master.port import BusError
from openacr.fieldbus.ethercat.wire import sii
from openacr.fieldbus.ethercat.wire.data_types import DataType
from openacr.fieldbus.machine.bringing_up import Brought, bring_up
from openacr.plant.describe.load import parse_world

MACHINE = """
[bus]
interface = "none"
[[axis]]
number = 0
counts_per_rev = 4000
drive = { mode = "exact" }
[axis.bus]
position = 0
mode = "csp"
torque_limit = 100.0
"""
Objects = tuple[tuple[int, DataType], ...]


def pdos(first: int, groups: list[Objects], *, fixed: bool) -> tuple[sii.Pdo, ...]:
    return tuple(
        sii.Pdo(
            first + n,
            tuple(sii.Entry(index, 0, kind.bits, "", kind) for index, kind in group),
            (2 if first == 0x1600 else 3) if n == 0 else 0xFF,
            is_fixed=fixed,
        )
        for n, group in enumerate(groups)
    )


def brought_up(receive: list[Objects], transmit: list[Objects], *, fixed: bool) -> Brought:
    world = drives_world(1)
    plant = Plant(world)
    out, in_ = pdos(0x1600, receive, fixed=fixed), pdos(0x1A00, transmit, fixed=fixed)
    usual = drive_description(1, 0)
    sizes = [sum(one.bits for one in side if one.sync != 0xFF) // 8 for side in (out, in_)]
    sync = (
        *usual.sync[:2],
        replace(usual.sync[2], size=sizes[0]),
        replace(usual.sync[3], size=sizes[1]),
    )
    described = replace(usual, receive=out, transmit=in_, sync=sync)
    drive = Drive(Motor(plant, world.axis[0]), "drive", description=described)
    return bring_up(SegmentLink(Segment([drive], plant)), parse_world(MACHINE), 0.001)


def objects(layout: object) -> list[int]:
    return [index for index, _, _ in layout.items]  # type: ignore[attr-defined]


def test_a_drive_with_small_pdos_gets_its_objects_in_several(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(pdo, "MOST_MAPPED", 2)
    receive: list[Objects] = [((0x6040, U16),), ((0x607A, I32),), ((0x6060, I8),)]
    transmit: list[Objects] = [((0x6041, U16),), ((0x6064, I32),), ((0x6061, I8),)]
    member = brought_up(receive, transmit, fixed=False).drives[0]
    assert objects(member.outputs) == [0x6040, 0x607A, 0x6072]
    assert objects(member.inputs) == [0x6041, 0x6064, 0x603F, 0x6061]


def test_fixed_pdos_that_hold_the_objects_are_assigned() -> None:
    receive: list[Objects] = [
        ((0x6040, U16), (0x60FF, I32)),
        ((0x6040, U16), (0x607A, I32)),
        ((0x6072, U16),),
    ]
    transmit: list[Objects] = [
        ((0x6041, U16), (0x606C, I32)),
        ((0x603F, U16), (0x6061, I8)),
        ((0x6041, U16), (0x6064, I32)),
    ]
    member = brought_up(receive, transmit, fixed=True).drives[0]
    assert objects(member.outputs) == [0x6040, 0x607A, 0x6072]
    assert objects(member.inputs) == [0x603F, 0x6061, 0x6041, 0x6064]
    assert member.inputs.place(of.ACTUAL_POSITION) == 5


def test_fixed_pdos_without_an_object_are_refused_with_its_name() -> None:
    receive: list[Objects] = [((0x6040, U16), (0x607A, I32))]
    transmit: list[Objects] = [((0x6041, U16), (0x6064, I32), (0x603F, U16), (0x6061, I8))]
    with pytest.raises(BusError, match=r"no process data for 0x6072 \(largest torque\)"):
        brought_up(receive, transmit, fixed=True)
