"""`openacr bus emulate`: what it refuses, and what is typed while it runs."""

from pathlib import Path

import pytest
from tests import warm
from tests.fieldbus.ethercat.veth import emulated


def refused(*words: str) -> str:
    done = warm.run(["bus", "emulate", *words], text=True, encoding="utf-8", capture_output=True)
    assert done.returncode == 2, done
    return str(done.stderr)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "a segment has at least one drive or terminal: --drives 1"),
        (["--drives", "17"], "17 drives: a segment has 0 to 16"),
        (["--drives", "1", "--fault", "loose 5"], "loose: the faults are cable-out,"),
        (["--drives", "1", "--fault", "2.5 lose"], "lose: write lose N"),
        (["examples/gantry", "--drives", "1"], "give MACHINE or --drives, not both"),
        (["no-such.toml"], "no-such.toml"),
        (["--digital", "1", "--interface", "no-such"], "no-such: "),
    ],
)
def test_wrong_words_are_refused_with_a_hint(words: list[str], said: str) -> None:
    error = refused(*words)
    assert said in error
    assert "Traceback" not in error


def test_the_drives_of_a_machine_are_its_motors_and_faults_are_typed(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(
        '[[axis]]\nnumber = 3\nname = "Z"\ncounts_per_rev = 4000\ndrive = { mode = "exact" }\n'
    )
    with emulated(str(tmp_path), "--digital", "1") as slaves:
        assert slaves.say("power-off 1") == "slave 1 has no power"
        assert slaves.say("loose 1").startswith("error: loose: the faults are")
        assert slaves.end().splitlines() == [
            "0 Z: INIT, DISABLED at 0",
            "1 digital: no power",
            "0 frames",
        ]
