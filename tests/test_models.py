"""Controller models differ in what they have."""

from msgspec.structs import replace
from tests.controller.hosts import Host

from openacr.controller import Controller
from openacr.map.numbers import P_SYSFLASH1_VERSION
from openacr.models import ACR8020, ACR9000, ACR9040, DEFAULT_MODEL, MODELS
from openacr.units import explain, words_of


def test_the_default_card_is_an_eight_axis_acr9000() -> None:
    assert DEFAULT_MODEL is ACR9000
    assert (ACR9000.axes, ACR9000.masters, ACR9000.slaves) == (8, 8, 8)


def test_models_differ_in_axes_connectors_and_masters() -> None:
    assert {
        model.name: (model.axes, model.connected_axes, model.masters) for model in MODELS.values()
    } == {
        "ACR1200": (8, 2, 8),
        "ACR1500": (8, 4, 8),
        "ACR1505": (8, 8, 16),
        "ACR2000": (8, 4, 8),
        "ACR8000": (8, 8, 8),
        "ACR8010": (8, 8, 8),
        "ACR8020": (16, 16, 16),
        "ACR9000": (8, 8, 8),
        "ACR9030": (16, 16, 16),
        "ACR9040": (16, 16, 16),
    }


def test_version_and_serial_number() -> None:
    assert ACR8020.version == "ACR8020 Version 1.18.06 Update 15"
    assert ACR8020.serial_number == 80200000


def test_a_name_is_written_once_and_says_the_card_type() -> None:
    assert {name: model.name for name, model in MODELS.items()} == {name: name for name in MODELS}
    assert MODELS["ACR1505"].serial_number == 15050000
    assert (ACR8020.firmware_number, ACR8020.update) == (11806, 15)


def test_what_only_some_models_have() -> None:
    rows = MODELS.values()
    assert {row.name for row in rows if row.has_canopen} == {"ACR9000", "ACR9030", "ACR9040"}
    assert {row.name: row.lines for row in rows if row.lines != 32} == {"ACR2000": 16}
    assert {row.name for row in rows if row.has_battery} == {"ACR1505", "ACR8020"}
    assert not any(row.has_digits_in_names for row in rows), "see `digits_in_names`"
    assert {row.name: str(row.lacks) for row in rows if row.lacks} == {
        "ACR1500": "no NURBs and no look-ahead",
        "ACR8000": "no user flash",
    }
    assert {row.name: row.commutators for row in rows if row.commutators != 8} == {"ACR8000": 0}
    assert {row.name for row in rows if "DPCB" in row.streams} == {"ACR1505", "ACR8020"}
    fixed = {row.name for row in rows if row.has_fixed_adc_mode}
    assert fixed == {"ACR9000", "ACR9030", "ACR9040"}


def test_a_card_shows_the_board_information_of_its_model() -> None:
    model = replace(ACR9040, firmware="2.03.01", update=4)
    controller = Controller(model)
    shown = [controller.memory.I[number] for number in (7040, 7042, 7043)]
    assert shown == [90400000, 20301, 4]
    host = Host(controller)
    assert "ACR9040 Version 2.03.01 Update 4" in host.type("VER")
    host.type("FIRMWARE CHECKSUM")
    assert controller.memory.I[P_SYSFLASH1_VERSION] == 20301
    host.type("REBOOT")
    controller.advance(100)
    assert [controller.memory.I[number] for number in (7040, 7042, 7043)] == shown


def test_units_are_explained() -> None:
    assert words_of("V s²/pulse") == ["V", "s", "pulse"]
    assert explain("V s²/pulse") == "volt, second, encoder pulse"
