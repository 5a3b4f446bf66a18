"""A card as notebooks show it."""

from pathlib import Path

from openacr.controller import Controller
from openacr.plant.describe import schema

SQUARE = Path(__file__).parents[2] / "examples" / "square"


def test_a_notebook_shows_motors_and_stored_programs_at_this_moment() -> None:
    card = Controller.from_project(SQUARE)
    card.send("PROG0\rRUN\r")
    card.advance(400)
    first, second = card.axis(0), card.axis(1)
    assert first.actual_u > 0.0
    cells = (0, "X", "rev", f"{first.commanded_u:.6g}", f"{first.actual_u:.6g}",
             first.following_error)  # fmt: skip
    other = (1, "Y", "rev", "0", f"{second.actual_u:.6g}", second.following_error)
    line = int(card.p[7168])
    assert card._repr_html_() == (
        "<p>ACR9000: 0.2 s since power-up, 400 servo periods</p>"
        "<table><tr><th>axis</th><th>name</th><th>units</th><th>commanded</th><th>actual</th>"
        "<th>following error [pulses]</th></tr>"
        + "".join(
            "<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in (cells, other)
        )
        + "</table><table><tr><th>program</th><th>state</th><th>line</th></tr>"
        f"<tr><td>PROG0</td><td>running</td><td>{line}</td></tr></table>"
    )
    assert line > 0


def test_a_halted_program_and_a_plc_have_no_line() -> None:
    card = Controller.from_project(SQUARE)
    card.send("SYS\rDIM PLC3(500)\rPLC3\rPROGRAM\rLD 32\rOUT 33\rENDP\rRUN\r")
    card.advance(400)
    assert card._repr_html_().endswith(
        "<tr><td>PROG0</td><td>halted</td><td></td></tr>"
        "<tr><td>PLC3</td><td>running</td><td></td></tr></table>"
    )


def test_names_of_a_machine_are_shown_as_text() -> None:
    drive = schema.IdealDrive(revs_per_s_per_volt=25.0)
    motor = schema.Axis(number=2, drive=drive, name="<b>", units="mm & µm")
    shown = Controller(world=schema.World(axis=(motor,)))._repr_html_()
    assert "<tr><td>2</td><td>&lt;b&gt;</td><td>mm &amp; µm</td>" in shown
    assert shown.count("<tr>") == 3
