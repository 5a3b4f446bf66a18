"""On a full disk, and in a folder that is read-only: one sentence, and nothing that is half there.

The disk is a file system of 256 KiB in a name space of its own, where the system allows that.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from openacr.sysvar import Store
from openacr.sysvar.tabs import SPEEDS

OPENACR = (sys.executable, "-m", "openacr")
TO_MOUNT = ("unshare", "--user", "--map-root-user", "--mount")
# Without these capabilities modes hold for root, too.
PLAIN = ("setpriv", "--inh-caps=-all", "--bounding-set=-all") if os.geteuid() == 0 else ()
FILLED = """
mount -t tmpfs -o size=256k tmpfs "$1" && cd "$1" && shift && cp ../kept.db . || exit 99
dd if=/dev/zero of=fill bs=4k 2>/dev/null
"$@"; code=$?
rm fill; cp kept.db ..; ls -A > ../left
exit $code
"""
STARTS = "starting the panel ...\n"  # said before the disk is looked at
STORED = {"kept.db", "kept.db-seq", "kept.db-shm", "kept.db-wal"}


def is_possible(*words: str) -> bool:
    """Whether the system lets the tests do this."""
    return bool(shutil.which(words[0])) and not subprocess.call([*words, "true"], stderr=-3)


@pytest.mark.skipif(not is_possible(*TO_MOUNT), reason="this system lets nothing be mounted")
@pytest.mark.parametrize(
    ("words", "said", "left"),
    [
        (("new", "p", "--no-ask"), "p: cannot be written: no space left on device", ()),
        (("examples", "copy", "gantry", "g"), "g: cannot be written: no space left on device", ()),
        (("panel", "--no-browser", "--port", "0", "--store", "s.db"),
         "programs: cannot be written: no space left on device", ()),
        (("sysvar", "set", "cut speed=7", "--store", "kept.db"),
         "kept.db cannot be read or written: the disk is full (the index of its log needs 32 KiB)",
         ()),
        (("sysvar", "set", "cut speed=7", "--store", "new.db"), "the disk is full",
         ("new.db", "new.db-seq")),  # a new store takes them over
        (("run", "../square.8k", "--for", "0.1", "--trace", "t.csv"),
         "t.csv: cannot be written: no space left on device", ()),
        (("run", "../square.8k", "--for", "0.1", "--journal", "j"),
         "j: cannot be written: no space left on device", ()),
    ],
)  # fmt: skip
def test_a_full_disk_is_said_and_nothing_is_lost_or_half_there(
    tmp_path: Path, words: tuple[str, ...], said: str, left: tuple[str, ...]
) -> None:
    with Store(tmp_path / "kept.db") as store:
        store.write(SPEEDS.cut_speed, 5.0)
    (tmp_path / "square.8k").write_text("PROG0\n")
    (tmp_path / "disk").mkdir()
    script = [*TO_MOUNT, "sh", "-c", FILLED, "sh", str(tmp_path / "disk"), *OPENACR, *words]
    ended = subprocess.run(script, capture_output=True, text=True, check=False)
    assert ended.returncode == 2, ended.stderr
    error = ended.stderr.removeprefix(STARTS)
    assert error.count("\n") == 1
    assert error.startswith("error: ")
    assert said in error
    assert set((tmp_path / "left").read_text().split()) - STORED <= set(left)
    with Store(tmp_path / "kept.db") as store:
        assert store.read(SPEEDS.cut_speed) == 5.0


@pytest.mark.skipif(not is_possible(*TO_MOUNT), reason="this system lets nothing be mounted")
def test_files_of_a_run_on_other_disks_are_written_and_what_it_did_is_said(tmp_path: Path) -> None:
    (tmp_path / "square.8k").write_text("PROG0\n")
    (tmp_path / "kept.db").write_text("")
    (tmp_path / "disk").mkdir()
    words = ("run", "../square.8k", "--for", "0.1", "--summary", "s.json", "--trace", "../t.csv")
    script = [*TO_MOUNT, "sh", "-c", FILLED, "sh", str(tmp_path / "disk"), *OPENACR, *words]
    ended = subprocess.run(
        [*script, "--plot", "p.svg"], capture_output=True, text=True, check=False
    )
    no_space = "cannot be written: no space left on device"
    assert (ended.returncode, ended.stderr) == (
        2,
        f"error: s.json: {no_space}\nerror: p.svg: {no_space}\n",
    )
    assert "0.1000 s simulated in 200 ticks" in ended.stdout
    assert (tmp_path / "t.csv").read_text().startswith("time_s")
    assert set((tmp_path / "left").read_text().split()) == {"kept.db"}


@pytest.mark.skipif(PLAIN != () and not is_possible(*PLAIN), reason="root may write anywhere")
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("panel", "--no-browser", "--port", "0", "--store", "a/s.db"), "a: cannot be written"),
        (("panel", "--no-browser", "--port", "0", "--programs", "a/b"), "a: cannot be written"),
        (("new", "p", "--no-ask"), "p: cannot be written"),
    ],
)  # fmt: skip
def test_a_folder_that_is_read_only_is_said(
    tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    data = tmp_path / "data"
    data.mkdir()
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o555)
    ended = subprocess.run(
        [*PLAIN, *OPENACR, *words],
        cwd=folder,
        env={**os.environ, "XDG_DATA_HOME": str(data)},
        capture_output=True,
        text=True,
        check=False,
    )
    error = ended.stderr.removeprefix(STARTS)
    assert (ended.returncode, error) == (2, f"error: {said}: permission denied\n")
    assert not list(folder.iterdir())
