"""A run that is ended from outside writes what it has; closed streams are no reason to fail."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from tests import warm

ROOT = Path(__file__).parents[2]
if sys.platform == "win32":
    pytest.skip("signals and streams of POSIX", allow_module_level=True)

PROGRAM = """\
SYS
DIM PROG0(1000)
PROG0
PROGRAM
10 PRINT "begun"
12 DWL 0.1
14 PRINT "goes on"
20 DWL 0.01
30 GOTO 20
ENDP
"""
SCENARIO = """\
duration_s = 3600.0
[[at]]
time_s = 0.0
send = "PROG0\\rRUN\\r"
[[expect]]
name = "it begins"
time_s = 0.02
printed = "begun"
[[expect]]
name = "much later"
time_s = 3000.0
flag = 1032
is = true
[[expect]]
name = "in the end"
flag = 1032
is = true
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "endless"
    folder.mkdir()
    (folder / "setup.8k").write_text(PROGRAM)
    (folder / "scenario.toml").write_text(SCENARIO)
    return folder


ENVIRONMENT = {**os.environ, "PYTHONUNBUFFERED": "1"}


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_an_ended_run_writes_its_results_and_counts_what_was_not_reached(
    number: signal.Signals, project: Path, tmp_path: Path
) -> None:
    summary, trace = tmp_path / "s.json", tmp_path / "t.csv"
    job = warm.Popen(
        ["run", project, "--realtime", "--summary", summary, "--trace", trace], text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=ENVIRONMENT,
    )  # fmt: skip
    assert job.stdout is not None
    assert [job.stdout.readline() for _ in range(2)] == ["begun\n", "goes on\n"]
    job.send_signal(number)
    out, err = job.communicate(timeout=60)
    assert job.returncode == 130
    assert "1 of 3 expectations met, 2 not reached" in err
    assert "the results end there" in err
    assert "PROG0" in out
    found = json.loads(summary.read_text())
    assert found["scenario"]["not_reached"] == ["much later", "in the end"]
    assert [one["name"] for one in found["scenario"]["expectations"]] == ["it begins"]
    assert 1 < len(trace.read_text().splitlines()) <= found["ticks"] + 1


def _closed(streams: tuple[int, ...], *words: str) -> tuple[int, str]:
    """Run with descriptors closed as `>&-` does; what it wrote to the error stream."""

    def close() -> None:
        for descriptor in streams:
            os.close(descriptor)

    job = subprocess.Popen(
        [sys.executable, "-m", "openacr", *words], text=True, stderr=subprocess.PIPE, cwd=ROOT,
        env=ENVIRONMENT, preexec_fn=close,
    )  # fmt: skip
    _, err = job.communicate(timeout=60)
    return job.returncode, err


@pytest.mark.parametrize("streams", [(1,), (0, 1), (0,)])
def test_a_run_without_streams_runs(streams: tuple[int, ...], tmp_path: Path) -> None:
    summary = tmp_path / "s.json"
    code, err = _closed(
        streams, "run", "examples/square", "--for", "0.5", "--quiet", "--summary", str(summary)
    )
    assert "Traceback" not in err
    assert json.loads(summary.read_text())["ticks"] == 1000
    assert code in (0, 1)


def test_mdi_without_input_has_no_blocks_to_run() -> None:
    code, err = _closed((0,), "mill", "mdi")
    assert (code, err) == (0, "")
