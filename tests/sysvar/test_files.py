"""Files that are damaged, foreign, read-only, or on a full disk: said clearly, nothing lost."""

import os
import random
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from openacr.errors import StoreError
from openacr.sysvar import Store


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A store with some values, closed."""
    path = tmp_path / "s.db"
    with Store(path) as store, store.transaction():
        for n in range(1001, 1301):
            store.write(n, n / 1000)
        store.write_text(100_006, "OLD.LOG")
    return path


@pytest.mark.parametrize("size", [1, 100, 1000, 4096, 5000, 8192, 10_000])
def test_a_torn_file_is_refused_and_left_as_it_is(path: Path, size: int) -> None:
    data = path.read_bytes()
    assert len(data) > 10_000
    path.write_bytes(data[:size])
    with pytest.raises(StoreError, match=r"s\.db is damaged .*import an export"):
        Store(path)
    assert path.read_bytes() == data[:size]


def test_a_file_that_lost_all_its_bytes_is_no_new_store(path: Path) -> None:
    path.write_bytes(b"")
    with pytest.raises(StoreError, match="is empty although settings were stored in it"):
        Store(path)


def test_an_empty_file_where_no_store_was_becomes_one(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    path.touch()
    with Store(path) as store:
        assert store.read(650_000) == 200.0


def test_damage_anywhere_gives_the_values_or_an_error(path: Path) -> None:
    data = path.read_bytes()
    chance = random.Random(1)
    outcomes = set()
    for _ in range(60):
        damaged = bytearray(data)
        start = chance.randrange(len(data) - 64)
        damaged[start : start + 64] = chance.randbytes(64)
        path.write_bytes(damaged)
        try:
            with Store(path) as store:
                store.read(1001)
            outcomes.add("read")
        except StoreError as error:
            assert str(path) in str(error)
            outcomes.add("refused")
    assert "refused" in outcomes


def test_another_kind_of_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    path.write_text("G1 X1\n" * 1000)
    with pytest.raises(StoreError, match="is damaged and cannot be read"):
        Store(path)
    assert path.read_text().startswith("G1 X1")


def test_the_database_of_another_program_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    with sqlite3.connect(path) as other:
        other.execute("CREATE TABLE songs (name)")
    other.close()
    with pytest.raises(StoreError, match="belongs to another program or a newer version"):
        Store(path)


def test_a_newer_layout_is_refused(path: Path) -> None:
    with sqlite3.connect(path) as later:
        later.execute("PRAGMA user_version = 2")
    later.close()
    with pytest.raises(StoreError, match="a newer version"):
        Store(path)


def test_a_value_of_the_wrong_kind_is_refused_and_the_file_let_go(path: Path) -> None:
    with sqlite3.connect(path) as foreign:
        foreign.execute("UPDATE cell SET value = 'long' WHERE number = 1001")
    foreign.close()
    with pytest.raises(StoreError, match=r"holds 'long' for P1001 D radius 1"):
        Store(path)
    used = [link for link in Path("/proc/self/fd").glob("*") if str(path) in os.path.realpath(link)]
    assert used == []


def test_a_folder_is_no_store(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="cannot be opened"):
        Store(tmp_path)
    with pytest.raises(StoreError, match="cannot be opened"):
        Store(Path("/dev/null/s.db"))


def test_on_a_full_disk_a_group_is_refused_whole_and_the_old_values_stay(path: Path) -> None:
    with Store(path) as store:
        connection = store._database._connection
        (pages,) = connection.execute("PRAGMA page_count").fetchone()
        connection.execute(f"PRAGMA max_page_count = {pages}")
        with pytest.raises(StoreError, match="the disk is full; nothing of this was stored"):
            with store.transaction():
                for n in range(2001, 2999):
                    store.write(n, 1.5)
        assert (store.read(2001), store.read(1001)) == (0.0, 1.001)
        connection.execute("PRAGMA max_page_count = 100000")
        store.write(2001, 2.5)
    with Store(path) as store:
        assert (store.read(2001), store.read(2002), store.read(1001)) == (2.5, 0.0, 1.001)


LIMITED = """
import resource, signal, sys
from openacr.errors import StoreError
from openacr.sysvar import Store
store = Store(sys.argv[1])
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
try:
    with store.transaction():
        for n in range(2001, 2999):
            store.write(n, 1.5)
except StoreError as error:
    print(error)
"""


def test_a_file_that_may_not_grow_loses_nothing(path: Path) -> None:
    said = _python(LIMITED, str(path))
    assert str(path) in said
    assert "cannot be" in said
    with Store(path) as store:
        assert (store.read(2001), store.read(1001)) == (0.0, 1.001)


READER = """
import os, sys
from openacr.errors import StoreError
from openacr.sysvar import Store
if os.geteuid() == 0:
    os.seteuid(65534)
store = Store(sys.argv[1])
print(store.read(1001), store.read_text(100_006), store.is_read_only)
try:
    store.write(1001, 2.0)
except StoreError as error:
    print(error)
"""


def test_a_file_that_may_not_be_written_can_be_read(path: Path) -> None:
    path.chmod(0o444)
    for folder in (path.parent, *path.parent.parents[:3]):
        folder.chmod(0o555 if folder == path.parent else folder.stat().st_mode | 0o111)
    try:
        said = _python(READER, str(path)).splitlines()
    finally:
        path.parent.chmod(0o755)
    assert said[0] == "1.001 OLD.LOG True"
    assert said[1].endswith("s.db is read-only: nothing can be stored")


def _python(code: str, *arguments: str) -> str:
    ran = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout
