"""What a card keeps without power, seen by a host: REBOOT, and power-up with a data folder."""

import sqlite3
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest
from tests.controller.hosts import Host, connected, store

from openacr.controller import Controller
from openacr.controller.recorder import Recorder
from openacr.errors import StoreError, UserError
from openacr.project import find_project

SETTINGS = (
    "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PPU X1000", "PGAIN X0.01",
    "ACC 123.456", "VEL 7", "JOG VEL X3.5", "EXC X(0.5,-0.25)", "HLIM X3", "SLM X(9,-1)",
    "DAC1 GAIN 3000", "MULT X-4", "P32768=9", "P33024=3", "NOTCH X(100,20)", "VECDEF X0",
)  # fmt: skip
FACTORY_DEFAULT = (
    "HALT ALL", "NEW ALL", "DETACH ALL", "CLEAR", "ERASE", "FLASH ERASE", "CONFIG CLEAR",
    "CLEAR DPCB", "CLEAR FIFO", "CLEAR COM1", "CLEAR COM2", "BRESET",
)  # fmt: skip
OMITTED = {  # what the guide says to omit for which model
    "ACR1505": set[str](), "ACR8020": set[str](),
    "ACR8000": {"FLASH ERASE", "CLEAR DPCB"}, "ACR9000": {"CLEAR DPCB", "CLEAR FIFO"},
}  # fmt: skip
SHARES = "".join(f"DIM PROG{program}(65536)|" for program in range(8))
BLINK = ("PBOOT", "_LOOP1", "BIT 32 = NOT BIT 32", "DWL 0.25", "GOTO LOOP1")

PowerUp = Callable[..., Host]


@pytest.fixture
def power_up(tmp_path: Path) -> PowerUp:
    """A host of a card on the data folder; the card before it is without power from now on."""
    cards: list[Controller] = []

    def switch(model: str = "ACR8020") -> Host:
        if cards:
            cards[-1].close()
        cards.append(Controller(model, data=tmp_path))
        return Host(cards[-1])

    return switch


def notices(host: Host) -> str:
    return " ".join(host.card.nonvolatile.notices)


# ESAVE, ELOAD, ERASE


def test_eload_is_refused_while_something_runs_or_moves() -> None:
    host = connected(*SETTINGS, "DRIVE ON X", "ESAVE")
    host.card.advance(100)
    host.type("JOG FWD X", "SYS")
    host.card.advance(100)
    assert host.type("ELOAD") == "Programs running|SYS>"
    host.type("AXIS0 JOG OFF")
    host.card.advance(10_000)
    assert host.type("ELOAD") == "SYS>"
    host.type("PROG1", "10 DWL 100", "RUN", "SYS")
    assert host.type("ELOAD") == "Programs running|SYS>"
    assert host.type("FLASH SAVE", "FLASH ERASE") == "Programs running|SYS>" * 2


def test_a_program_can_save() -> None:
    host = connected("PROG0", "ATTACH MASTER0")
    store(host, "ACC 55", "ESAVE")
    host.type("RUN")
    host.card.advance(100)
    host.type("REBOOT", "PROG0")
    assert host.ask("ACC") == "55"


@pytest.mark.req("ACR-IP-02")
def test_a_saved_address_is_used_after_reboot(power_up: PowerUp) -> None:
    host = power_up("ACR9000")
    host.type('IP "10.0.3.7"', 'IP MASK "255.0.0.0"', "ESAVE", "REBOOT")
    assert host.type("IP") == "IP 10.0.3.7|MASK 255.0.0.0|GATE 0.0.0.0|SYS>"
    assert power_up("ACR9000").type("IP").startswith("IP 10.0.3.7|")


@pytest.mark.req("ACR-OUTMOD-01")
@pytest.mark.parametrize("model", ["ACR9000", "ACR8020"])
def test_a_stepper_card_stays_one(model: str) -> None:
    lines = ["CONFIG NONE STEPPER4 STEPPER4 NONE"]
    lines += [f"ATTACH AXIS{n} STEPPER{n} STEPPER{n}" for n in range(8)]
    host = connected(*lines, "ESAVE", "REBOOT", model=model)
    assert host.type("CONFIG") == "CONFIG NONE STEPPER4 STEPPER4 NONE|SYS>"
    attached = host.type("ATTACH").split("|")[:8]
    assert attached == [f"ATTACH AXIS{n} STEPPER{n} STEPPER{n} STEPPER{n}" for n in range(8)]


# FLASH


def test_flash_save_leaves_the_variables_of_a_battery_alone() -> None:
    host = connected("DIM P(10)", "P1 = 5", "FLASH SAVE", "P1 = 6", "REBOOT", model="ACR8020")
    assert host.ask("?P1") == "6"


def test_a_program_comes_back_that_names_axes_not_attached_yet() -> None:
    host = connected("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS2 "ROLL"')
    store(host, 'ATTACH SLAVE0 AXIS2 "ROLL"', "ROLL 5 JOG VEL ROLL (2 * 3)", "IF (1) THEN ROLL/1")
    listing = host.type("LIST")
    host.type("SYS", "FLASH SAVE", "REBOOT", "PROG0")
    assert host.type("ATTACH") == "P00>"
    assert host.type("LIST") == listing
    assert notices(host) == ""


# start-up programs


@pytest.mark.req("ACR-PBOOT-01", "ACR-PBOOT-05")
def test_the_blinking_light_blinks_after_reboot_and_after_power_up(power_up: PowerUp) -> None:
    host = power_up("ACR9000")
    host.type("PROG0")
    store(host, *BLINK)
    host.type("SYS", "FLASH SAVE", "REBOOT")
    assert _changes(host) == 4
    host = power_up("ACR9000")
    assert _changes(host) == 4


def _changes(host: Host) -> int:
    """How often output 32 changes in a second, not counting the first time."""
    host.card.advance(seconds=0.1)
    states = [host.card.bit[32]]
    for _ in range(100):
        host.card.advance(seconds=0.01)
        states.append(host.card.bit[32])
    return sum(a != b for a, b in pairwise(states))


# reset


@pytest.mark.req("ACR-RST-03", "ACR-RST-04")
@pytest.mark.parametrize("model", OMITTED)
def test_the_factory_default_sequence(power_up: PowerUp, model: str) -> None:
    fresh = _factory_state(connected(model=model))
    host = power_up(model)
    host.type("DIM P(10)", "DIM DEF(3)", "DIM COM1(1000)", "DIM PROG8(9000)", "CONFIG CLEAR")
    host.type("CONFIG ENC4 NONE NONE NONE", "#DEFINE Count P1", 'IP "10.0.0.1"', *SETTINGS)
    store(host, "PBOOT", "DWL 1000")
    host.type("RUN", "ESAVE", "HALT", "SYS", "FLASH IMAGE")
    assert _factory_state(host) != fresh
    host.type("SYS")
    sequence = [line for line in FACTORY_DEFAULT if line not in OMITTED[model]]
    assert [host.type(line) for line in sequence] == ["SYS>"] * len(sequence)
    assert host.type("REBOOT") == "SYS>"
    assert _factory_state(host) == fresh
    assert _factory_state(power_up(model)) == fresh


def _factory_state(host: Host) -> list[str]:
    found = [host.type("SYS")]
    found += [host.type(line) for line in ("CONFIG", "DIM", "DEF", "ATTACH", "IP", "MEM")]
    for axis in range(8):
        found += host.asks(f"AXIS{axis} PPU", f"AXIS{axis} PGAIN", f"AXIS{axis} JOG VEL")
    found += host.asks("MASTER0 ACC", "MASTER0 VEL", "MASTER0 JRK", "?P32768", "DAC1 GAIN")
    return found + [host.type(f"PROG{n}", "ATTACH", "LIST") for n in range(16)]


def test_what_a_card_does_not_have_is_refused() -> None:
    host = connected()
    assert host.type("CLEAR DPCB", "CLEAR FIFO") == "Invalid device|SYS>" * 2


# battery


def test_a_battery_keeps_what_was_typed_through_a_power_cut(
    power_up: PowerUp, tmp_path: Path
) -> None:
    host = power_up()
    host.type("DIM P(10)", "DIM DEF(2)", "#DEFINE Count P1", "CONFIG ENC4 NONE NONE NONE")
    host.type("DIM PLC0(1000)", 'PASSWORD ON "x"', 'PASSWORD OFF "x"', "PROG0")
    host.type("10 PRINT Count", "20 DWL 1", "30 GOTO 10", "20", "DIM DA(2)", "DIM DA1(3)")
    host.type("DIM $V(1,10)", '$V0 = "text"', "Count = 5.5", "DA1(2) = 1.25", "P38912 = 4")
    host.card.advance(seconds=1.1)
    again = Host(Controller("ACR8020", data=_copied(tmp_path)))
    assert again.type("PROG0", "LIST") == "P00>10 PRINT Count|30 GOTO 10|P00>"
    assert again.ask("?Count;DA1(2);$V0;P38912") == "5.51.25text4"
    assert again.type("SYS", "CONFIG", "PASSWORD") == (
        "SYS>CONFIG ENC4 NONE NONE NONE|SYS>OFF|SYS>"
    )
    assert again.type("DIM") == host.type("SYS", "DIM").removeprefix("SYS>")
    assert again.type("MEM PROG0") == host.type("MEM PROG0")


def _copied(folder: Path) -> Path:
    """The data folder as a power cut leaves it."""
    copy = folder / "copy"
    copy.mkdir()
    for path in folder.glob("card.db*"):
        (copy / path.name).write_bytes(path.read_bytes())
    return copy


def test_a_clean_end_keeps_the_last_values(power_up: PowerUp) -> None:
    host = power_up()
    host.type("DIM P(10)", "P1 = 5")
    assert power_up().ask("?P1") == "5"


def test_a_card_without_battery_forgets(power_up: PowerUp) -> None:
    host = power_up("ACR9000")
    host.type("DIM P(10)", "P38912 = 1", "PROG0", "10 PRINT 1", "REBOOT")
    assert host.type("DIM", "?P38912", "PROG0", "LIST") == SHARES + "SYS>0|SYS>P00>P00>"
    assert power_up("ACR9000").type("DIM", "PROG0", "LIST") == SHARES + "SYS>P00>P00>"


@pytest.mark.req("ACR-CMD-BRESET", "ACR-MEM-04")
def test_breset_takes_the_battery_away_until_power_is_removed(power_up: PowerUp) -> None:
    host = power_up()
    host.type("DIM P(10)", "DIM PROG8(5000)", "PROG0", "10 PRINT 1", "SYS")
    assert host.type("BRESET") == "SYS>"
    assert host.type("DIM") == SHARES + "DIM PROG8(5000)|DIM P(10)|SYS>"
    assert host.type("REBOOT", "DIM", "PROG0", "LIST") == f"SYS>{SHARES}SYS>P00>P00>"
    host.type("10 PRINT 2", "REBOOT", "PROG0")
    assert host.type("LIST") == "P00>"
    host.type("10 PRINT 3")
    host = power_up()
    assert host.type("PROG0", "LIST") == "P00>P00>"
    host.type("10 PRINT 4", "REBOOT", "PROG0")
    assert host.type("LIST") == "10 PRINT 4|P00>"
    assert power_up().type("PROG0", "LIST") == "P00>10 PRINT 4|P00>"


# damage


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("parameters", "what was lost: parameters"),
        ("flash", "what was lost: flash"),
        ("battery", "sizes, aliases and variables of battery-backed memory are lost"),
        ("battery text 0", "what was lost: battery text 0"),
    ],
)
def test_a_damaged_image_gives_defaults_and_is_named(
    power_up: PowerUp, tmp_path: Path, name: str, said: str
) -> None:
    host = power_up()
    host.type(*SETTINGS, "ESAVE", "10 PRINT 1", "SYS", "DIM P(10)")
    if name == "flash":
        host.type("FLASH SAVE")
    host.card.close()
    with sqlite3.connect(tmp_path / "card.db") as file:
        file.execute("UPDATE image SET data = zeroblob(20) WHERE name = ?", (name,))
    file.close()
    host = power_up()
    assert said in notices(host)
    assert host.heard().startswith("Warning: ")
    assert (host.ask("AXIS0 PPU") == "1") == (name == "parameters")
    is_lost = name == "battery text 0"
    assert host.type("PROG0", "LIST") == ("P00>P00>" if is_lost else "P00>10 PRINT 1|P00>")
    assert ("DIM P(10)" in host.type("SYS", "DIM")) == (name != "battery")
    host.type("ESAVE", "FLASH SAVE")
    assert notices(power_up()) == ""
    assert (tmp_path / "card.db.damaged1").exists()


def test_one_flipped_bit_costs_one_program_and_every_host_is_informed(
    power_up: PowerUp, tmp_path: Path
) -> None:
    host = power_up()
    host.type("DIM P(10)", "P1 = 2.5", "PROG0", "10 PRINT 1", "PROG1", "10 PRINT 2")
    host.card.close()
    with sqlite3.connect(tmp_path / "card.db") as file:
        file.execute(
            "UPDATE image SET data = CAST(replace(data, CAST('PRINT 1' AS BLOB), CAST('QRINT 1' AS"
            " BLOB)) AS BLOB) WHERE name = 'battery text 0'"
        )
    file.close()
    damaged = (tmp_path / "card.db").read_bytes()
    host = power_up()
    said = f"Warning: {tmp_path / 'card.db'} is damaged; it was kept as card.db.damaged1;"
    assert host.heard() == f"{said} what was lost: battery text 0|"
    assert Host(host.card).heard() == f"{said} what was lost: battery text 0|"
    assert host.type("?P1", "PROG0", "LIST", "PROG1", "LIST") == (
        "2.5|SYS>P00>P00>P01>10 PRINT 2|P01>"
    )
    assert (tmp_path / "card.db.damaged1").read_bytes() == damaged
    host.close()
    again = Host(host.card)
    assert again.heard() == ""  # once for each channel
    assert power_up().heard() == ""


def test_what_this_version_cannot_read_is_kept(power_up: PowerUp) -> None:
    host = power_up()
    host.type("PROG0", "10 PRINT 1")
    host.card.nonvolatile.store.write({"battery text 3": b"\x01"})
    host = power_up()
    assert "it was kept as 'unreadable battery text 3'" in notices(host)
    assert host.card.nonvolatile.store.read("unreadable battery text 3") == b"\x01"
    host.heard()
    assert host.type("PROG0", "LIST") == "P00>10 PRINT 1|P00>"


def test_what_a_card_keeps_is_for_its_owner_alone(power_up: PowerUp, tmp_path: Path) -> None:
    host = power_up()
    host.type('PASSWORD ON "secret"')
    host.card.recorder = Recorder(host.card, tmp_path / "a.journal")
    host.card.close()
    names = {path.name: path.stat().st_mode & 0o777 for path in tmp_path.iterdir()}
    assert names == {"card.db": 0o600, "a.journal": 0o600}


def test_a_file_that_is_no_database_does_not_keep_the_card_from_starting(
    power_up: PowerUp, tmp_path: Path
) -> None:
    (tmp_path / "card.db").write_bytes(b"nonsense" * 1000)
    host = power_up()
    assert "card.db.damaged1" in notices(host)
    assert host.heard().startswith("Warning: ")
    assert host.type("DIM P(10)", "ESAVE") == "SYS>SYS>"
    assert power_up().type("DIM") == SHARES + "DIM P(10)|SYS>"


def test_data_of_another_model_is_refused(power_up: PowerUp, tmp_path: Path) -> None:
    power_up("ACR8020").card.close()
    with pytest.raises(StoreError, match="was stored by an ACR8020, the card is an ACR9000"):
        Controller("ACR9000", data=tmp_path)
    assert Controller("ACR8020", data=tmp_path).nonvolatile.notices == []


def test_a_full_disk_is_an_error_of_the_command(
    power_up: PowerUp, monkeypatch: pytest.MonkeyPatch
) -> None:
    host = power_up("ACR9000")

    def fail(changes: object, *, flush: bool = True) -> None:
        raise StoreError("no space left")

    monkeypatch.setattr(host.card.nonvolatile.store.images, "write", fail)
    assert host.type("ESAVE") == "Save failed|SYS>"
    assert "no space left" in notices(host)


def test_a_battery_catches_up_when_the_disk_has_room_again(
    power_up: PowerUp, monkeypatch: pytest.MonkeyPatch
) -> None:
    host = power_up()
    host.type("DIM P(10)", "P1 = 1", "PROG0", "10 PRINT 1")
    tries = 0

    def fail(changes: object, *, flush: bool = True) -> None:
        nonlocal tries
        tries += 1
        raise StoreError("no space left")

    with monkeypatch.context() as full:
        full.setattr(host.card.nonvolatile.store.images, "write", fail)
        host.type("10 PRINT 2", "20 PRINT 3", "SYS", "P1 = 2")
        for _ in range(30):
            host.card.advance(seconds=0.1)
    assert 3 <= tries <= 5  # the text at once, then once a second
    assert "battery-backed memory is not stored until this is corrected" in notices(host)
    again = power_up()
    assert again.type("PROG0", "LIST") == "P00>10 PRINT 2|20 PRINT 3|P00>"
    assert again.ask("?P1") == "2"


# projects


def test_a_card_with_programs_keeps_them_when_a_project_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("PROG0\nPROGRAM\nPRINT 1\nENDP\nSYS\nFLASH SAVE\n")
    project = find_project(tmp_path)
    first, errors = Controller.load(project, data=tmp_path / "data")
    assert (errors, first.nonvolatile.notices) == ([], [])
    host = Host(first)
    host.type("PROG0", "NEW", "10 PRINT 2", "SYS", "FLASH SAVE")
    first.close()
    second, errors = Controller.load(project, data=tmp_path / "data")
    assert errors == []
    assert "keeps them" in " ".join(second.nonvolatile.notices)
    assert Host(second).type("PROG0", "LIST") == "P00>10 PRINT 2|P00>"
    second.close()


@pytest.mark.parametrize("kind", [str, Path])
def test_folder_and_machine_are_given_as_text_or_path(
    tmp_path: Path, kind: type[str] | type[Path]
) -> None:
    machine = tmp_path / "machine.toml"
    machine.write_text("[card]\nperiod_s = 0.001\n")
    card = Controller(world=kind(machine), data=kind(tmp_path / "data"))
    assert card.period_s == 0.001
    assert card.device_folder == tmp_path
    card.send('IP "192.168.10.47"\rESAVE\r')
    card.close()
    again = Controller(data=kind(tmp_path / "data"))
    assert "192.168.10.47" in again.send("IP\r")
    again.close()
    with pytest.raises(UserError, match=r"none\.toml"):
        Controller(world=kind(tmp_path / "none.toml"))
