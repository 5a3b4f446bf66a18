"""What a user may hand over, and what is said when it cannot be used."""

from pathlib import Path

import pytest

from openacr.errors import OpenacrError, SourceError, UserError
from openacr.project import Place, decode, find_project


def write(folder: Path, **files: str) -> Path:
    for name, text in files.items():
        (folder / name.replace("__", ".")).write_text(text)
    return folder


def test_a_folder_is_read_in_the_order_setup_plcs_programs(tmp_path: Path) -> None:
    write(
        tmp_path,
        setup__8k="DIM P(10)\n",
        prog10__8k="PROGRAM\nENDP\n",
        prog2__8k="PROGRAM\nENDP\n",
        plc1__8k="10 LD 1\n",
        machine__toml="",
        scenario__toml="",
    )
    project = find_project(tmp_path)
    assert [(s.place, s.number) for s in project.sources] == [
        (Place.SETUP, 0),
        (Place.PLC, 1),
        (Place.PROGRAM, 2),
        (Place.PROGRAM, 10),
    ]
    assert project.machine == tmp_path / "machine.toml"
    assert project.scenario == tmp_path / "scenario.toml"


def test_a_single_file_is_its_own_setup(tmp_path: Path) -> None:
    path = write(tmp_path, part__8K="PROG0\n") / "part.8K"
    project = find_project(path)
    assert project.setup is not None
    assert project.setup.text == "PROG0\n"
    assert project.machine is None


def test_names_from_systems_without_case_are_found(tmp_path: Path) -> None:
    project = find_project(write(tmp_path, SETUP__8K="DIM P(1)", PROG3__8K="PROGRAM"))
    assert [source.number for source in project.programs] == [3]
    assert project.setup is not None


def test_other_controller_files_of_a_folder_are_named_as_ignored(tmp_path: Path) -> None:
    project = find_project(write(tmp_path, setup__8k="DIM P(1)", backup__8k="DIM P(2)"))
    assert project.ignored == (tmp_path / "backup.8k",)


@pytest.mark.parametrize(
    ("name", "data", "text"),
    [
        ("empty.8k", b"", "empty.8k: the file is empty"),
        ("blank.8k", b"\r\n \x1a", "blank.8k: the file is empty"),
        ("image.8k", b"PROG0\nab\x00c", "image.8k:2:3: not a text file: byte 0x00 at offset 8"),
        ("wide.8k", "PROG0".encode("utf-16"), "wide.8k:1:1: the file is UTF-16"),
    ],
)
def test_a_file_that_is_no_text_is_refused_with_its_place(
    tmp_path: Path, name: str, data: bytes, text: str
) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(SourceError) as caught:
        find_project(tmp_path / name)
    assert text in str(caught.value)


def test_a_missing_path_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"nowhere: no such file or folder"):
        find_project(tmp_path / "nowhere")


def test_a_folder_without_any_project_file_says_what_belongs_there(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"not an openacr project: .*prog0\.8k \.\. prog15\.8k"):
        find_project(write(tmp_path, notes__txt="hello"))


def test_the_machine_file_alone_is_not_a_project(tmp_path: Path) -> None:
    path = write(tmp_path, machine__toml="", setup__8k="DIM P(1)") / "machine.toml"
    with pytest.raises(UserError, match="give the project folder"):
        find_project(path)


@pytest.mark.parametrize(
    ("names", "text"),
    [
        (("prog16.8k",), r"there is no PROG16; the files are prog0.8k .. prog15.8k"),
        (("plc8.8k",), r"there is no PLC8; the files are plc0.8k .. plc7.8k"),
        (("prog1.8k", "prog01.8k"), r"prog01.8k already is PROG1"),
        (("setup.8k", "SETUP.8K"), r"same file; keep one"),
    ],
)
def test_contradicting_file_names_are_refused(
    tmp_path: Path, names: tuple[str, ...], text: str
) -> None:
    for name in names:
        (tmp_path / name).write_text("REM")
    with pytest.raises(OpenacrError, match=text):
        find_project(tmp_path)


def test_one_bad_file_refuses_the_whole_folder(tmp_path: Path) -> None:
    write(tmp_path, setup__8k="DIM P(1)")
    (tmp_path / "prog0.8k").write_bytes(b"\x7fELF")
    with pytest.raises(SourceError, match=r"prog0\.8k:1:1: not a text file: byte 0x7F"):
        find_project(tmp_path)


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"PRINT \x93x\x94", "PRINT “x”"),
        (b"INH \x96516", "INH –516"),
        ("PRINT “ü”".encode(), "PRINT “ü”"),
        ("“".encode() + b"\x94", "“”"),
        (b"A\xa0B", "A\xa0B"),
        (b"\xef\xbb\xbfPROG0", "PROG0"),
        (b"\x81", "\x81"),
    ],
)
def test_utf8_is_tried_first_and_then_the_single_byte(data: bytes, text: str) -> None:
    assert decode(data) == text
