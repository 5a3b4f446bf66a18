"""The pytest plugin in test runs of their own, as another project uses it."""

import re
import sys
import xml.etree.ElementTree as Xml
from pathlib import Path

import matplotlib.figure  # noqa: F401
import pytest

# Modules that are imported during a run are forgotten at its end, and numpy is imported once.
import openacr.testing.bench
import openacr.testing.coverage_report
import openacr.testing.golden
import openacr.testing.pictures
import openacr.testing.strategies  # noqa: F401

pytest_plugins = ["pytester"]
pytestmark = pytest.mark.timeout(900)  # test runs in test runs, on a machine that may be busy

SETUP = (
    "SYS\nDIM PROG0(4000)\nDIM P(10)\nDIM PROG1(2000)\nPROG0\nATTACH MASTER0\n"
    'ATTACH SLAVE0 AXIS0 "X"\nPPU X1000\nPGAIN X0.002\nDRIVE ON X\nACC 500 DEC 500 STP 500 VEL 20\n'
)
PROGRAM = """\
PROGRAM
P0 = P0 + 1
IF (P0 > 5)
P1 = 99
ELSE
X/0.5
ENDIF
IF (P0 = 77) THEN GOTO Never
PRINT "done"
END
_Never
P2 = 1
ENDP
"""


@pytest.fixture
def shop(pytester: pytest.Pytester) -> pytest.Pytester:
    machine = pytester.path / "shop"
    machine.mkdir()
    (machine / "setup.8k").write_text(SETUP)
    (machine / "prog0.8k").write_text(PROGRAM)
    pytester.makeini("[pytest]\nopenacr_project = shop\naddopts = -p no:cacheprovider\n")
    return pytester


def run(shop: pytest.Pytester, text: str, *options: str) -> str:
    """The output of a test run in this process."""
    shop.makepyfile(test_shop=text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", "200")
        patch.setattr(sys, "dont_write_bytecode", True)  # the same file is written within a second
        done = shop.runpytest_inprocess("-p", "no:xdist", *options)
    return done.stdout.str() + done.stderr.str()


def test_every_test_gets_the_card_as_new(shop: pytest.Pytester) -> None:
    out = run(shop, """
        def test_one(card, machine, advance, until):
            assert card is machine.card
            assert (card.p[0], card.tick < 100000) == (0, True)
            machine.send("PROG0\\rRUN\\r")
            took_s = until("P0 = 1", limit_s=1)
            assert took_s < 0.1
            until("BIT1024 = 0", limit_s=5)
            assert machine.printed.strip() == "done"
            card.listen(lambda program, text: None)
            advance(seconds=0.1)

        def test_two(card, machine, until):
            assert card.p[0] == 0
            assert machine.printed == ""
            machine.send("PROG0\\rRUN\\r")
            until(lambda: abs(card.axis(0).actual_u - 0.5) < 0.01, 5)
    """)  # fmt: skip
    assert "2 passed" in out, out


def test_projects_come_from_parametrisation_and_marker_and_none_is_a_bare_card(
    shop: pytest.Pytester,
) -> None:
    other = shop.path / "other"
    other.mkdir()
    (other / "machine.toml").write_text('[card]\nmodel = "ACR1505"\n')
    (shop.path / "alone.8k").write_text(f"{SETUP}{PROGRAM}")
    out = run(shop, """
        import pytest

        @pytest.mark.parametrize("machine", ["shop", "other"], indirect=True)
        def test_each(card):
            assert card.model.name in ("ACR9000", "ACR1505")

        @pytest.mark.openacr(project="other")
        def test_marked(card):
            assert card.model.name == "ACR1505"

        @pytest.mark.openacr("alone.8k")
        def test_file(card):
            assert card.system.programs.texts[0]
    """)  # fmt: skip
    assert "4 passed" in out, out
    (shop.path / "pytest.ini").unlink(missing_ok=True)
    (shop.path / "tox.ini").write_text("[pytest]\naddopts = -p no:cacheprovider\n")
    out = run(shop, "def test_bare(card):\n    assert card.model.name == 'ACR9000'\n")
    assert "1 passed" in out, out


def test_a_condition_that_does_not_hold_says_the_values_and_draws_the_last_moments(
    shop: pytest.Pytester,
) -> None:
    out = run(shop, """
        def test_never(machine, until):
            machine.send("PROG0\\rRUN\\r")
            until("P12290 > 100000", limit_s=0.5)

        def test_wrong(until):
            until("P12290 is far")

        def test_output(until):
            until("BIT34 = 1", limit_s=0.01)
    """, "--openacr-pictures", "pictures")  # fmt: skip
    assert "3 failed" in out, out
    assert "BIT34 (OUTPUT: OUT 34) is 0" in out
    assert "P12290 > 100000 did not hold within 0.5 s: P12290 (AXIS 0: Actual Position) is 5" in out
    assert re.search(r"axis 0: commanded 0\.5, actual 0\.\d+", out), out
    assert "openacr: the last moments" in out
    assert re.search(r"axis 0 position +▁[▁-█]+ 0 to 0\.5", out), out
    assert "printed: 'done" in out
    assert "a condition is P or BIT, its number, one of <= >= <> = < > and a value" in out
    picture = shop.path / "pictures" / "test_never.png"
    assert f"picture: {Path('pictures', 'test_never.png')}" in out
    assert picture.read_bytes().startswith(b"\x89PNG")


GOLDEN = """
    def test_move(machine, golden):
        machine.send("PROG0\\rRUN\\r")
        machine.advance(seconds=0.4)
        golden.check(0)
"""


def test_golden_traces_are_written_on_request_and_compared(shop: pytest.Pytester) -> None:
    assert "there is no golden trace" in run(shop, GOLDEN)
    assert "1 passed" in run(shop, GOLDEN, "--openacr-update")
    path = shop.path / "golden" / "test_move.csv"
    assert path.read_text().startswith("time_s,axis0_u\n")
    assert "1 passed" in run(shop, GOLDEN)
    (shop.path / "shop" / "setup.8k").write_text(SETUP.replace("VEL 20", "VEL 2"))
    out = run(shop, GOLDEN)
    assert re.search(r"test_move\.csv: axis 0 at \d\.\d+ s is .*, it was .* apart", out), out
    assert "1 failed" in run(shop, GOLDEN.replace("0.4", "0.5"))


COVERED = """
    def test_move(machine, until):
        machine.send("PROG0\\rRUN\\r")
        until("P0 = 1", 1)
        until("BIT1024 = 0", 5)
"""


def test_lines_and_branches_that_were_executed_are_counted(shop: pytest.Pytester) -> None:
    lcov, pages = shop.path / "cov.info", shop.path / "pages"
    out = run(
        shop, COVERED, "--openacr-cov", "--openacr-cov-lcov", str(lcov),
        "--openacr-cov-html", str(pages),
    )  # fmt: skip
    assert "1 passed" in out, out
    file = str(shop.path / "shop" / "prog0.8k")
    row = next(line for line in out.splitlines() if line.startswith(file))
    assert row.split()[1:] == ["8", "2", "4", "2", "67%", "4,", "12"]
    assert lcov.read_text() == (
        f"SF:{file}\nDA:2,1\nDA:3,1\nBRDA:3,0,0,1\nBRDA:3,0,1,0\nDA:4,0\nDA:6,1\nDA:8,1\n"
        "BRDA:8,0,0,0\nBRDA:8,0,1,1\nDA:9,1\nDA:10,1\nDA:12,0\nBRF:4\nBRH:2\nLF:8\nLH:6\n"
        "end_of_record\n"
    )
    page = next(pages.glob("*_prog0.html")).read_text()
    table = Xml.fromstring(page[page.index("<table>") : page.index("</table>") + 8])
    assert [row.get("class") for row in table] == [
        "", "hit", "part", "miss", "", "hit", "", "part", "hit", "hit", "", "miss", "",
    ]  # fmt: skip
    assert "prog0.8k" in (pages / "index.html").read_text()
    assert "coverage of AcroBASIC" not in run(shop, COVERED)


def test_random_worlds_are_machines_the_programs_run_on(shop: pytest.Pytester) -> None:
    (shop.path / "shop" / "machine.toml").write_text(
        "[[axis]]\nnumber = 0\nencoder_lines = 250\nunits_per_rev = 1.0\n[axis.motor]\n"
        "inertia_kgm2 = 1.9e-5\ntorque_nm_per_a = 0.45\n[axis.load]\ninertia_kgm2 = 1e-5\n"
        '[axis.drive]\nmode = "velocity"\nrevs_per_s_per_volt = 10.0\npeak_amps = 15.0\n'
    )
    out = run(shop, """
        import openacr
        from hypothesis import given, settings
        from openacr.testing.machine import Machine
        from openacr.testing.strategies import worlds

        seen = set()

        @settings(max_examples=5, deadline=None)
        @given(worlds("shop/machine.toml", initial_u=2.0))
        def test_it_arrives(world):
            seen.add((world.axis[0].load.inertia_kgm2, world.axis[0].initial))
            machine = Machine(openacr.Controller.from_project("shop", world=world))
            machine.begin()
            machine.send("PROG0\\rRUN\\r")
            machine.until("BIT1024 = 0", 5)
            assert machine.card.world is world

        def test_they_differ():
            assert len(seen) > 1
    """)  # fmt: skip
    assert "2 passed" in out, out


def test_a_run_without_cards_imports_nothing_of_the_plugin_but_itself(
    shop: pytest.Pytester,
) -> None:
    shop.makepyfile(test_shop="""
        import sys

        def test_modules():
            found = {name for name in sys.modules if name.split(".")[0] == "openacr"}
            assert found == {"openacr", "openacr.pytest_plugin"}
            assert "numpy" not in sys.modules
    """)  # fmt: skip
    done = shop.run(sys.executable, "-m", "pytest", "-p", "no:xdist")
    done.stdout.fnmatch_lines("*1 passed*")


def test_fixtures_are_described(shop: pytest.Pytester) -> None:
    out = run(shop, "def test(): pass\n", "--fixtures")
    for name in ("machine", "card", "advance", "until", "golden"):
        assert re.search(rf"^{name} -- ", out, re.MULTILINE), out
