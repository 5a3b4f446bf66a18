"""Images on disk: atomic, checked, owned by one process."""

import random
import sqlite3
from pathlib import Path

import pytest

from openacr.errors import StoreError
from openacr.store import Database, Image, Images, Scratch
from openacr.store.images import needs_version


@pytest.fixture(params=["disk", "memory"])
def images(request: pytest.FixtureRequest, tmp_path: Path) -> Images:
    return Database(tmp_path) if request.param == "disk" else Scratch()


def test_what_was_written_is_read_and_what_was_deleted_is_gone(images: Images) -> None:
    images.write({"a": Image(1, b"one"), "b": Image(2, b"")})
    images.write({"a": Image(1, b"two"), "b": None, "c": Image(3, bytes(300_000))}, flush=False)
    assert images.names() == ["a", "c"]
    assert images.read("a") == Image(1, b"two")
    assert images.read("b") is None
    assert images.read("c") == Image(3, bytes(300_000))


def test_a_closed_file_is_read_by_the_next_one(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "folder"
    first = Database(folder)
    first.write({"a": Image(1, b"one")})
    first.close()
    assert Database(folder).read("a") == Image(1, b"one")


def test_a_save_that_fails_in_the_middle_changes_nothing(tmp_path: Path) -> None:
    images = Database(tmp_path)
    images.write({"a": Image(1, b"old"), "b": Image(1, b"old")})
    unfit = Image("no number", b"")  # type: ignore[arg-type]
    with pytest.raises(AttributeError):
        images.write({"a": Image(1, b"new"), "b": unfit})
    assert images.read("a") == Image(1, b"old")
    assert images.read("b") == Image(1, b"old")


def test_a_folder_belongs_to_one_card_at_a_time(tmp_path: Path) -> None:
    first = Database(tmp_path)
    with pytest.raises(StoreError, match="in use by another card"):
        Database(tmp_path)
    first.close()
    Database(tmp_path).close()


def test_a_changed_byte_is_found(tmp_path: Path) -> None:
    images = Database(tmp_path)
    images.write({"programs": Image(1, b"PROG0"), "other": Image(1, b"whole")})
    images.close()
    with sqlite3.connect(images.path) as file:
        file.execute("UPDATE image SET data = ? WHERE name = 'programs'", (b"PROG1",))
    file.close()
    images = Database(tmp_path)
    with pytest.raises(StoreError, match=r"the stored programs in .* is damaged"):
        images.read("programs")
    assert images.read("other") == Image(1, b"whole")


@pytest.mark.parametrize(
    "content", [b"no database at all" * 100, b"SQLite format 3\0" + b"\xff" * 5000]
)
def test_a_file_that_is_no_database_is_put_aside(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "card.db").write_bytes(content)
    images, said = Database.open(tmp_path)
    assert "is damaged and cannot be read; it was kept as card.db.damaged1" in str(said)
    assert (tmp_path / "card.db.damaged1").read_bytes() == content
    images.write({"a": Image(1, b"one")})
    images.close()
    again, said = Database.open(tmp_path)
    assert said is None
    assert again.read("a") == Image(1, b"one")


def test_of_a_torn_file_what_is_whole_goes_on(tmp_path: Path) -> None:
    images = Database(tmp_path)
    images.write({"a": Image(1, b"small"), "b": Image(1, bytes(range(250)) * 400)})
    images.close()
    whole = images.path.read_bytes()
    images.path.write_bytes(whole[: len(whole) // 2])
    images, said = Database.open(tmp_path)
    assert "it was kept as card.db.damaged1" in str(said)
    images.write({"b": Image(1, b"new")})
    images.close()
    again, said = Database.open(tmp_path)
    assert said is None
    assert again.read("b") == Image(1, b"new")


def test_a_damaged_overflow_page_costs_its_image_and_later_saves_succeed(tmp_path: Path) -> None:
    images = Database(tmp_path)
    big = Image(1, random.Random(1).randbytes(100_000))
    images.write({"a": Image(1, b"one"), "big": big, "z": Image(1, b"two")})
    images.close()
    content = bytearray(images.path.read_bytes())
    page = content.index(big.data[5000:5100]) // 4096 * 4096
    content[page : page + 4] = b"\xff\xff\xff\xff"  # the next page of the chain
    images.path.write_bytes(content)
    images, said = Database.open(tmp_path)
    assert str(said).endswith("is damaged; it was kept as card.db.damaged1; what was lost: big")
    assert (tmp_path / "card.db.damaged1").read_bytes() == content
    assert images.names() == ["a", "z"]
    assert images.read("z") == Image(1, b"two")
    images.write({"big": big, "a": None})
    images.close()
    again, said = Database.open(tmp_path)
    assert (said, again.names()) == (None, ["big", "z"])
    assert again.read("big") == big


def test_the_file_of_another_program_is_left_alone(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "card.db") as file:
        file.execute("PRAGMA user_version = 7")
        file.execute("CREATE TABLE image (x)")
    file.close()
    before = (tmp_path / "card.db").read_bytes()
    with pytest.raises(StoreError, match="another program or a newer version"):
        Database.open(tmp_path)
    assert (tmp_path / "card.db").read_bytes()[100:] == before[100:]


def test_a_folder_that_cannot_be_made_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("an obstacle")
    with pytest.raises(StoreError, match="cannot be used"):
        Database(tmp_path / "file" / "data")


def test_an_image_of_another_format_is_refused() -> None:
    assert needs_version("x", Image(1, b"data"), 1) == b"data"
    with pytest.raises(StoreError, match="format 2, this program reads format 1"):
        needs_version("x", Image(2, b"data"), 1)
