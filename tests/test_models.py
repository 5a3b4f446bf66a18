"""Controller models differ in what they have."""

from openacr.models import ACR8020, ACR9000, DEFAULT_MODEL, MODELS
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
        "ACR7000": (8, 8, 16),
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


def test_units_are_explained() -> None:
    assert words_of("V s²/pulse") == ["V", "s", "pulse"]
    assert explain("V s²/pulse") == "volt, second, encoder pulse"
