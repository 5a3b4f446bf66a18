"""NURBs and look-ahead are missing on the ACR1500: said before a run, not by its failure."""

from pathlib import Path

import pytest
from tests.controller.hosts import X_AND_Y, Host
from typer.testing import CliRunner

from openacr.channels import StreamKind
from openacr.cli.main import app
from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.mill.session import MillSession, Start
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code1, Code3
from openacr.sysvar import Store
from openacr.sysvar.tabs import GENERAL

MACHINE = '[card]\nmodel = "{}"\n'
SETUP = 'PROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\nATTACH SLAVE1 AXIS1 "Y"\n'
PROGRAM = "PROGRAM\nVEL 5\n  NURB MODE 1\nX1 Y1 NK 0\nMBUF ON : LOOK ON\nSPLINE MODE 1\nENDP\n"


def card(model: str) -> tuple[Controller, Host]:
    controller = Controller(model)
    host = Host(controller)
    host.type(*X_AND_Y)
    return controller, host


@pytest.mark.parametrize(
    "line",
    [
        "NURB", "NURB MODE 1", "NURB RANK 3", "NURB END", "NK 0 X1", "K 0 NW 2 X1",
        "LOOK", "LOOK ON", "LOOK ANG(0,45)", "LOOK MINVEL 1", "LOOK TOL 0.1", "MASTER0 LOOK ON",
    ],
)  # fmt: skip
def test_its_commands_are_not_supported_by_an_acr1500_neither_typed_nor_stored(line: str) -> None:
    controller, host = card("ACR1500")
    assert host.type(line) == "Not supported|P00>"
    assert host.type(f"10 {line}") == "Not supported|P00>"
    assert host.type("LIST") == "P00>"
    controller.advance(1000)
    assert controller.axis(0).actual_cnt == 0
    assert "Not supported" not in card("ACR8010")[1].type(line)


def test_at_the_system_level_it_is_refused_too() -> None:
    for model, answer in (("ACR1500", "Not supported|SYS>"), ("ACR8010", "SYS>")):
        host = card(model)[1]
        host.type("SYS")
        assert host.type("MASTER0 LOOK ON") == answer
        assert host.type("LOOK ON") == "Unknown command|SYS>"


def test_splines_and_buffered_moves_are_on_every_model() -> None:
    controller, host = card("ACR1500")
    host.type("MBUF ON", "SPLINE MODE 1")
    assert host.ask("SPLINE") == "1"
    host.type("10 SPLINE MODE 1", "20 K 1 X1 Y0", "30 K 1 X2 Y2", "40 K 1 X3 Y0", "50 SPLINE END")
    host.type("RUN")
    controller.advance(4000)
    assert (controller.axis(0).actual_cnt, controller.axis(1).actual_cnt) == (3000, 0)


@pytest.mark.parametrize(("model", "counts"), [("ACR1500", 0), ("ACR8010", 3000)])
def test_packets_with_control_points_of_nurbs_move_only_cards_that_know_them(
    model: str, counts: int
) -> None:
    controller, _host = card(model)
    packets = Host(controller, StreamKind.PACKETS)
    for x in (0, 1000, 2000, 3000):
        move = Move.of({0: x}, scaling=(1.0, 1.0), code1=Code1.NURB, code3=Code3.CURVE)
        assert packets.send(move.encode()) == ""
    end = Move.of({}, scaling=(-1.0, 0.0), code1=Code1.NURB, code3=Code3.CURVE)
    assert packets.send(end.encode()) == ""
    controller.advance(20000)
    assert controller.axis(0).actual_cnt == counts


def project(folder: Path, model: str) -> Path:
    (folder / "machine.toml").write_text(MACHINE.format(model))
    (folder / "setup.8k").write_text(SETUP)
    (folder / "prog0.8k").write_text(PROGRAM)
    return folder


@pytest.mark.req("MILL-OV-NURBLOOK")
def test_a_check_names_the_model_and_what_it_lacks_and_nothing_is_run(tmp_path: Path) -> None:
    folder = project(tmp_path, "ACR1500")
    checked = CliRunner().invoke(app, ["check", str(folder)])
    assert (checked.exit_code, checked.stderr) == (1, "3 errors\n")
    text = "Not supported (the ACR1500 has no NURBs and no look-ahead)"
    found = [
        line.split("prog0.8k:")[1] for line in checked.stdout.split("\n") if "prog0.8k:" in line
    ]
    assert found == [f"3:3: {text}", f"4:7: {text}", f"5:11: {text}"]
    run = CliRunner().invoke(app, ["run", str(folder)])
    assert run.exit_code == 2
    refused = [line for line in run.stderr.split("\n") if line.startswith("error: ")]
    assert [line.split("prog0.8k:")[1] for line in refused] == [
        "3: Not supported", "4: Not supported", "5: Not supported",
    ]  # fmt: skip
    assert CliRunner().invoke(app, ["check", str(project(tmp_path, "ACR8010"))]).exit_code == 0


@pytest.mark.req("MILL-OV-NURBLOOK")
def test_part_programs_need_neither_the_front_end_looks_ahead_itself() -> None:
    zigzag = "".join(f"G1 X{n / 10} Y{(n % 2) / 10}\n" for n in range(1, 40))
    ticks = {}
    for model in ("ACR1500", "ACR8010"):
        store = Store()
        store.write_text(GENERAL.card_model, model)
        session = MillSession.virtual(store, say=lambda _text: None)
        assert session.virtual_card is not None
        assert session.virtual_card.model.name == model
        session.start(load(f"G90 F300\n{zigzag}M2\n", session.cells), Start())
        while session.runner.is_busy:
            session.step()
        assert session.runner.alarms.active == []
        assert session.runner.stream.host.position()[:2] == pytest.approx((3.9, 0.1), abs=1e-4)
        ticks[model] = session.virtual_card.tick
    assert ticks["ACR1500"] == ticks["ACR8010"]
