"""Set-ups, references and measurements as they are kept: what is taken, and what a list says."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from openacr.errors import UserError
from openacr.panel.server.kept import KeptFiles
from openacr.panel.server.kept_kinds import KINDS, KindWord

CHANNEL = {
    "source": "P12290", "color": "#1f77b4", "scale": "1", "offset": "0", "unit": "",
    "format": "plain",
}  # fmt: skip
SETUP = {"channels": [CHANNEL], "settings": {"mode": "single", "level": "0.5"}}
TRACE = {
    "label": "CH1", "id": "P12290", "name": "", "unit": "mm", "format": "plain", "color": "#1f77b4",
    "isFlag": False, "scale": 1.0, "offset": 0.0, "values": [1.5, None, -2.0],
}  # fmt: skip
REFERENCE = {"traces": [TRACE], "period": 0.001, "start": -10.0, "from": -10.0}
CURVE = {"time_s": [0.0, 0.1], "setpoint_cnt": [0.0, 100.0], "actual_cnt": [0.0, 90.5]}
RESPONSE: dict[str, Any] = {
    "magnitude_db": [3.0, -3.0], "phase_deg": [-90.0, -150.0], "frequency_hz": [], "coherence": [],
}  # fmt: skip
MOTOR = {**RESPONSE, "frequency_hz": [2.0, 60.0], "coherence": [1.0, 0.9]}
BODE = {"frequency_hz": [1.0, 10.0], "present": RESPONSE, "measured": MOTOR}
TUNING: dict[str, Any] = {
    "axis": "X",
    "at": "2026-11-27T14:00:00",
    "time_s": 0.55,
    "amplitude_cnt": 100.0,
    "band_hz": [2.0, 60.0],
    "present": {
        "gains": {"PGAIN": 0.002},
        "filters": None,
        "margins": {"phase_deg": 50.0, "gain_db": None, "is_stable": True},
        "figures": {"overshoot_percent": 12.0},
        "rms_error_cnt": 7.5,
        "step": CURVE,
    },
    "bode": BODE,
    "trial": {"figures": {"overshoot_percent": 13.0, "settling_s": None}, "measured": CURVE},
}
# of each kind: one, and another one
SAMPLES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "setup": (SETUP, {**SETUP, "settings": {}}),
    "reference": (REFERENCE, {**REFERENCE, "period": 0.002}),
    "tuning": (TUNING, {**TUNING, "axis": "Y"}),
}


def text(found: object) -> bytes:
    return json.dumps(found).encode()


def test_a_list_says_of_a_measurement_its_axis_and_time_as_they_are_now(tmp_path: Path) -> None:
    files = KeptFiles(tmp_path, "tuning")
    files.store("a", text(TUNING), replace=False)
    assert [(each["axis"], each["at"]) for each in files.entries()] == [("X", TUNING["at"])]
    file = tmp_path / "tuning" / "a.tuning.json"
    before = file.stat()
    files.store("a", text({**TUNING, "axis": "Y"}), replace=True)
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))  # a clock with coarse steps
    assert [each["axis"] for each in files.entries()] == ["Y"]
    with file.open("r+b") as same:  # an editor that replaces nothing
        same.write(file.read_bytes().replace(b'"Y"', b'"Z"'))
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns + 1_000_000_000))
    assert [each["axis"] for each in files.entries()] == ["Z"]


def test_a_set_up_is_text_with_lines_for_the_versions_of_a_project(tmp_path: Path) -> None:
    KeptFiles(tmp_path, "setup").store("a", text(SETUP), replace=False)
    lines = (tmp_path / "scope" / "a.setup.json").read_text().splitlines()
    assert ' "settings": {' in lines


@pytest.mark.parametrize(
    ("kind", "found", "why"),
    [
        ("setup", b"nonsense", "JSON is malformed"),
        ("setup", b"\xff\xfe", "mine is no set-up: "),
        ("setup", text(REFERENCE), "unknown field `traces`"),
        ("setup", text({**SETUP, "channels": [CHANNEL] * 10}), "length <= 9"),
        ("setup", text({"channels": [{**CHANNEL, "color": "red"}], "settings": {}}), "color"),
        ("reference", text({**REFERENCE, "period": 0}), "period"),
        ("reference", text({**REFERENCE, "traces": [{**TRACE, "values": ["1"]}]}), "values"),
        ("reference", b"[" * 100_000, "mine is no reference: "),
        ("tuning", text({**TUNING, "present": {}}), "gains"),
        ("tuning", text({**TUNING, "axis": "X" * 41}), "length <= 40"),
        ("tuning", text({**TUNING, "trial": {"figures": {}, "measured": {
            **CURVE, "actual_cnt": [1.0]}}}), "not as many values as times"),
        ("tuning", text({**TUNING, "trial": {"figures": {}, "measured": {
            **CURVE, "setpoint_cnt": [1.0]}}}), "not as many values as times"),
        ("tuning", text({**TUNING, "bode": {**BODE, "frequency_hz": [1.0]}}), "not as many"),
        ("tuning", text({**TUNING, "bode": {**BODE, "measured": RESPONSE}}), "not as many"),
        *(("tuning", text({**TUNING, "bode": {**BODE, part: {**whole, curve: [1.0]}}}), "not as")
          for part, whole, curve in (
              ("present", RESPONSE, "magnitude_db"), ("present", RESPONSE, "phase_deg"),
              ("measured", MOTOR, "magnitude_db"), ("measured", MOTOR, "phase_deg"),
              ("measured", MOTOR, "coherence"),
          )),
        ("tuning", text({**TUNING, "bode": {**BODE, "measured": {
            "magnitude_db": [], "phase_deg": []}}}), "not as many"),
        ("tuning", b'{"more": ' + b"[" * 100_000, "mine is no measurement: "),
    ],
)  # fmt: skip
def test_what_is_none_of_its_kind_is_refused_with_what_is_wrong(
    tmp_path: Path, kind: KindWord, found: bytes, why: str
) -> None:
    files = KeptFiles(tmp_path, kind)
    with pytest.raises(UserError, match=r"^mine is no ") as refused:
        files.store("mine", found, replace=False)
    assert why in str(refused.value)
    assert files.entries() == []


def test_a_text_that_is_too_long_as_a_file_is_not_stored(tmp_path: Path) -> None:
    files, zeros = KeptFiles(tmp_path, "tuning"), [0] * 8000
    gain = {"frequency_hz": zeros, "magnitude_db": zeros, "phase_deg": zeros, "coherence": zeros}
    curve = {"time_s": zeros, "setpoint_cnt": zeros, "actual_cnt": zeros}
    large = {
        **TUNING,
        "bode": {**gain, "present": gain, "measured": gain},
        "present": {**TUNING["present"], "step": curve},
        "trial": {"figures": {}, "measured": curve},
    }
    sent = json.dumps(large, separators=(",", ":")).encode()
    assert len(sent) < KINDS["tuning"].most_bytes
    with pytest.raises(UserError, match=r"^a has \d+ bytes: a measurement has 400000 at most"):
        files.store("a", sent, replace=False)
    assert files.entries() == []
