"""Times of LinuxCNC's planner for the programs of `trajectories`; it needs `linuxcnc-uspace`.

Its simulator runs without a screen; motion is sampled in every servo period of 1 ms, so that
times do not depend on the load of this machine. It refuses to run as root: then it runs as
`nobody`. Limits are those of `trajectories`; version 2.9 knows no jerk.
"""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from openacr.trajectory import Segment
from openacr.trajectory.path.setpoints import Reals

SYSTEM_PYTHON = "/usr/bin/python3"  # for which the package is built
PERIOD_S = 0.001
LIMIT_S = 240.0
INI = """[EMC]
MACHINE = bench
DEBUG = 0
VERSION = 1.1
[DISPLAY]
DISPLAY = dummy
CYCLE_TIME = 0.1
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = sim.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
BASE_PERIOD = 0
SERVO_PERIOD = 1000000
[HAL]
HALFILE = sim.hal
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 100
MAX_LINEAR_VELOCITY = 100
DEFAULT_LINEAR_ACCELERATION = 1000
MAX_LINEAR_ACCELERATION = 1000
NO_FORCE_HOMING = 1
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
[KINS]
KINEMATICS = trivkins coordinates=xyz
JOINTS = 3
"""
LIMITS = "MIN_LIMIT = -2000\nMAX_LIMIT = 2000\nMAX_VELOCITY = 100\nMAX_ACCELERATION = 1000\n"
HOMING = "HOME = 0\nHOME_SEQUENCE = 0\nHOME_SEARCH_VEL = 0\nHOME_LATCH_VEL = 0\n"
JOINT = LIMITS + HOMING + "TYPE = LINEAR\nFERROR = 50\nMIN_FERROR = 50\n"
HAL = """loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
loadrt sampler depth=16000 cfg=fff
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb sampler.0.pin.0
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb sampler.0.pin.1
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb sampler.0.pin.2
net tp iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net tc iocontrol.0.tool-change => iocontrol.0.tool-changed
net e iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
"""
DRIVER = """
import os, subprocess, sys, time
import linuxcnc
os.environ["HOME"] = os.getcwd()  # runuser sets that of the user
simulator = subprocess.Popen(["linuxcnc", "-r", "sim.ini"], stdin=subprocess.PIPE,
                             stdout=open("simulator.txt", "w"), stderr=subprocess.STDOUT)
PROBE = [sys.executable, "-c", "import linuxcnc; linuxcnc.stat().poll()"]
for _ in range(60):  # a process that asks too early never sees the status
    if not subprocess.run(PROBE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
        break
    time.sleep(0.5)
time.sleep(1.0)
found = linuxcnc.stat()
def status():
    while True:
        try:
            found.poll()
            return found
        except (SystemError, linuxcnc.error):
            time.sleep(0.02)
deadline = time.monotonic() + float(sys.argv[1])
def wait(condition):
    while not condition(status()):
        if time.monotonic() > deadline:
            sys.exit("the simulator does not get on")
        time.sleep(0.05)
def idle(now):
    return now.interp_state == linuxcnc.INTERP_IDLE and now.inpos
try:
    command = linuxcnc.command()
    for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
        command.state(state)
        command.wait_complete()
    command.home(-1)
    wait(lambda now: all(now.homed[:3]))
    for program in sys.argv[2:]:
        sampler = subprocess.Popen(["halsampler", "-t"], stdout=open(program + ".txt", "w"))
        command.mode(linuxcnc.MODE_AUTO)
        command.wait_complete()
        command.program_open(program)
        command.auto(linuxcnc.AUTO_RUN, 0)
        time.sleep(0.5)
        wait(idle)
        time.sleep(0.5)
        sampler.terminate()
        sampler.wait()
finally:
    simulator.communicate(b"\\n", timeout=20)
"""


def is_installed() -> bool:
    """Whether the simulator is there, and can be run by this user."""
    return shutil.which("linuxcnc") is not None and (os.getuid() != 0 or _as_nobody() != [])


def _as_nobody() -> list[str]:
    runuser = shutil.which("runuser")
    return [runuser, "-u", "nobody", "--"] if os.getuid() == 0 and runuser else []


def samples(
    programs: Mapping[str, Sequence[Segment]], starts: Mapping[str, Sequence[float]]
) -> dict[str, Reals]:
    """Positions in every servo period from the first motion to the last, program by program."""
    with tempfile.TemporaryDirectory(prefix="openacr-linuxcnc-") as name:
        folder = Path(name)
        ini = INI + "".join(f"[AXIS_{axis}]\n{LIMITS}" for axis in "XYZ")
        ini += "".join(f"[JOINT_{n}]\n{JOINT}" for n in range(3))
        files = {"sim.ini": ini, "sim.hal": HAL, "drive.py": DRIVER, "sim.var": ""}
        for file, text in files.items():
            (folder / file).write_text(text)
        for n, (key, segments) in enumerate(programs.items()):
            (folder / f"{n}.ngc").write_text(gcode(segments, starts[key]))
        if _as_nobody():
            for path in (folder, *folder.iterdir()):
                shutil.chown(path, "nobody")
        environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
        subprocess.run(
            [*_as_nobody(), SYSTEM_PYTHON, "drive.py", f"{LIMIT_S:g}",
             *(str(folder / f"{n}.ngc") for n in range(len(programs)))],
            cwd=folder, env=environment, timeout=LIMIT_S + 90.0, check=True,
            capture_output=True,
        )  # fmt: skip
        return {key: _moving(folder / f"{n}.ngc.txt") for n, key in enumerate(programs)}


def _moving(path: Path) -> Reals:
    """The samples from the last rest before the program to the first after it.

    The move to the start ends with a dwell of half a second; the program begins after it.
    Samples that were lost ("overrun") are not numbers.
    """
    lines = [line.split() for line in path.read_text().splitlines()]
    table = np.array([line[:4] for line in lines if "overrun" not in line], dtype=np.float64)
    places = (table[:, 0] - table[0, 0]).astype(int)
    rows: Reals = np.full((places[-1] + 1, 3), np.nan)
    rows[places] = table[:, 1:]
    moves = np.flatnonzero(np.abs(np.diff(rows, axis=0)).max(axis=1) > 1e-9)
    gaps = np.flatnonzero(np.diff(moves) > 0.3 / PERIOD_S)
    first = moves[gaps[-1] + 1] if len(gaps) else moves[0]
    return rows[first : moves[-1] + 2]


def gcode(segments: Sequence[Segment], start: Sequence[float]) -> str:
    """A program of lines, arcs of the XY plane and helices, from a start."""
    lines = ["G21 G17 G90 G91.1", "G0 " + _words(start), "G4 P0.5"]
    lines.append(f"G64 P{segments[0].tolerance_u:g}")
    at = tuple(start)
    for segment in segments:
        words = f"{_words(segment.end)} F{60.0 * segment.feed_ups:g}"
        arc = segment.arc
        if arc is None:
            lines.append(f"G1 {words}")
        else:
            code = "G3" if arc.sweep_rad > 0.0 else "G2"
            i, j = arc.centre[0] - at[arc.first_axis], arc.centre[1] - at[arc.second_axis]
            lines.append(f"{code} {words} I{i:.9f} J{j:.9f}")
        at = segment.end
    return "\n".join([*lines, "M2", ""])


def _words(point: Sequence[float]) -> str:
    return " ".join(f"{axis}{value:.9f}" for axis, value in zip("XYZ", point, strict=True))
