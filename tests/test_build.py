"""The compiled core: it is there where it can be, and made of what it may be made of."""

import ast
import os
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from openacr import compiled, messages, unity
from openacr.cnc.rows import scans
from openacr.compiled import looks_unchanged
from openacr.kernel.tick_cy import tick
from openacr.map.memory import Memory
from openacr.map.rows import axes, kernel
from openacr.map.words import candi
from openacr.unity import source_hash, unity_source, write_unity
from openacr.unity_c import UnityError

HEAD = "from openacr.views import F64\n\nLIMIT = 4\n\n"


def can_be_compiled() -> bool:
    """Whether this machine has what the compiled core needs."""
    has_compiler = any(shutil.which(name) for name in ("cc", "gcc", "clang"))
    return has_compiler and os.environ.get("OPENACR_PURE") != "1"


@pytest.mark.skipif(not can_be_compiled(), reason="no C compiler, or plain Python is asked for")
def test_with_a_compiler_the_core_is_compiled_from_the_present_sources() -> None:
    assert compiled.is_compiled
    assert compiled.extension.SOURCE_HASH == source_hash()


def core_of(folder: Path) -> SimpleNamespace:
    """A core in a folder where it can be built, with one source as old as itself."""
    package = folder / "src" / "openacr"
    (package / "kernel").mkdir(parents=True)
    (folder / "setup.py").touch()
    (package / "kernel" / "one_cy.py").write_text("A = 1\n")
    core = package / "_compiled.so"
    core.touch()
    for path in (package / "kernel" / "one_cy.py", core):
        os.utime(path, (1000, 1000))
    return SimpleNamespace(__file__=str(core), SOURCE_SIZES=[("kernel/one_cy.py", 6)])


def test_sources_as_old_and_as_long_as_compiled_are_not_read(tmp_path: Path) -> None:
    assert looks_unchanged(core_of(tmp_path), str(tmp_path / "src" / "openacr"))


@pytest.mark.parametrize("installed", [False, True])
def test_a_source_of_another_length_or_a_missing_one_is_noticed(
    tmp_path: Path, installed: bool
) -> None:
    core, package = core_of(tmp_path), tmp_path / "src" / "openacr"
    if installed:
        (tmp_path / "setup.py").unlink()
    source = package / "kernel" / "one_cy.py"
    source.write_text("A = 12\n")
    os.utime(source, (1000, 1000))
    assert not looks_unchanged(core, str(package))
    source.unlink()
    assert not looks_unchanged(core, str(package))


def test_a_source_that_is_newer_than_the_core_is_read_where_the_core_can_be_built(
    tmp_path: Path,
) -> None:
    core, package = core_of(tmp_path), tmp_path / "src" / "openacr"
    os.utime(package / "kernel" / "one_cy.py", (1001, 1001))
    assert not looks_unchanged(core, str(package))
    (tmp_path / "setup.py").unlink()  # an installed package: written by an installer in any order
    assert looks_unchanged(core, str(package))


def test_the_sizes_are_those_of_all_that_decides_the_core() -> None:
    sizes = dict(unity.source_sizes())
    assert sizes["kernel/tick_cy.py"] == len(Path(tick.__code__.co_filename).read_bytes())
    assert {"unity.py", "unity_c.py", "messages.py", "map/fingerprint.py"} <= set(sizes)
    assert {"cnc/rows/scans.py", "engine/loop_cy.py"} <= set(sizes)


@pytest.mark.skipif(os.environ.get("OPENACR_PURE") != "1", reason="the core may be compiled")
def test_plain_python_is_used_when_asked_for() -> None:
    assert not compiled.is_compiled


def test_the_joined_source_is_python_and_holds_the_whole_core() -> None:
    text = unity_source()
    names = {node.name for node in ast.parse(text.replace("LL", "")).body if hasattr(node, "name")}
    assert {"engine_run", "py_engine_run", "tick", "vm_run"} <= names


def test_an_unchanged_source_keeps_its_time_and_a_changed_one_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    joined(tmp_path, monkeypatch, "def f(n: int) -> int:\n    return n + LIMIT\n")
    target = tmp_path / "deep" / "core.pyx"
    write_unity(target, checked=False)
    os.utime(target, (1000, 1000))
    write_unity(target, checked=False)
    assert target.stat().st_mtime == 1000
    write_unity(target, checked=True)
    assert target.stat().st_mtime > 1000
    assert "CHECKED = True" in target.read_text()


def joined(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> str:
    folder = tmp_path / str(
        len(list(tmp_path.iterdir()))
    )  # what a file imports is kept by its name
    folder.mkdir()
    source = folder / "small_cy.py"
    source.write_text(HEAD + text)
    monkeypatch.setattr(unity, "source_files", lambda: [source])
    return unity_source()


def test_a_small_source_gets_c_types_and_literals(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = joined(
        tmp_path, monkeypatch, "def f(F: F64, n: int) -> float:\n    return F[n + LIMIT]\n"
    )
    assert "n: cython.longlong" in text
    assert "F[n + 4LL]" in text


def test_the_views_of_the_state_are_passed_as_one_pointer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = joined(
        tmp_path,
        monkeypatch,
        "from openacr.views import F32, I32\n"
        "def f(F: F64, I: I32, n: int, x: F64) -> float:\n    return F[I[n]] + x[n]\n"
        "def g(F: F64, I: I32, S: F32, x: F64) -> float:\n    return S[0] * f(F, I, 1, x)\n",
    )
    assert "def f(M: cython.p_char, n: cython.longlong, x: cython.p_double)" in text
    assert "return S[0LL] * f(M, 1LL, x)" in text


def test_every_integer_is_widened_before_anything_is_computed_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = joined(
        tmp_path,
        monkeypatch,
        "from openacr.views import I32, U8\n"
        "def f(I: I32, code: I32, text: U8, n: int) -> int:\n"
        "    I[n] += text[n]\n    I[I[n]] = code[n] * 2\n    return 1 << n\n",
    )
    body = text[text.index("def f(") :].splitlines()[2:]
    wide = "cython.cast(cython.longlong, {})"
    assert body == [
        f"    I[n] = {wide.format('I[n]')} + {wide.format('text[n]')}",
        f"    I[{wide.format('I[n]')}] = {wide.format('code[n]')} * 2LL",
        "    return 1LL << n",
    ]


def test_a_function_that_is_listed_so_has_an_entrance_without_the_lock_of_python(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = joined(
        tmp_path,
        monkeypatch,
        "from openacr.csystem import now_ns\n"
        '__all__ = ["f", "g"]\n__unlocked__ = ["f"]\n'
        "def f(F: F64) -> None:\n    F[0] = now_ns()\n"
        "def g(F: F64) -> None:\n    F[0] = 1.0\n",
    )
    assert "from cython.cimports.openacr.csystem import now_ns" in text
    unlocked, locked = (text[text.index(f"def py_{name}(") :].splitlines()[1:3] for name in "fg")
    assert [line.strip() for line in unlocked] == [
        "with cython.nogil:",
        "f(cython.cast(cython.p_char, cython.address(F[0])))",
    ]
    assert locked[0].strip() == "g(cython.cast(cython.p_char, cython.address(F[0])))"


def test_a_function_that_is_listed_so_becomes_part_of_its_callers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = joined(
        tmp_path,
        monkeypatch,
        '__all__ = ["f"]\n__inlined__ = ["f"]\n'
        "def f(F: F64) -> None:\n    F[0] = 2.0\n"
        "def g(F: F64) -> None:\n    f(F)\n",
    )
    first, second = text.index("def f("), text.index("def g(")
    assert "@cython.inline\n" in text[:first]
    assert "@cython.inline\n" not in text[first:second]
    assert "def py_f(" in text


def test_a_function_of_c_gets_a_pointer_also_where_views_are_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = (
        "from openacr.csystem import frame_exchange\nfrom openacr.views import U8\n"
        "def f(X: U8, Y: U8, n: int) -> int:\n"
        "    return frame_exchange(n, X, X[0], Y, n, n, n)\n"
    )
    joined(tmp_path, monkeypatch, source)
    assert "frame_exchange(n, X, " in unity_source()
    text = unity_source(checked=True)
    assert "frame_exchange(n, cython.address(X[0]), " in text
    assert ", cython.address(Y[0]), n, n, n)" in text


def test_every_compiled_source_is_joined_after_those_it_imports() -> None:
    files = unity.source_files()
    names = [path.name for path in unity.joining_order(files)]
    assert sorted(names) == sorted(path.name for path in files)
    assert names.index("words_cy.py") < names.index("arith_cy.py") < names.index("vm_cy.py")
    assert names.index("vm_cy.py") < names.index("scheduler_cy.py") < names.index("loop_cy.py")


def test_sources_that_import_each_other_cannot_be_joined(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "openacr").mkdir()
    monkeypatch.setattr(unity, "PACKAGE", tmp_path / "openacr")
    for name, other in (("one", "two"), ("two", "one")):
        text = f"from openacr.{other}_cy import LIMIT\n"
        (tmp_path / "openacr" / f"{name}_cy.py").write_text(text)
    with pytest.raises(UnityError, match=r"import each other: .*one_cy -> two_cy"):
        unity.joining_order(unity.source_files())


MESSAGE = (
    "from openacr import messages\n"
    "def f(n: int) -> int:\n    return -messages.MATH_ERROR.number if n else n.real\n"
)


def test_the_number_of_a_message_is_taken_from_its_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "return -10LL if n else n.real" in joined(tmp_path, monkeypatch, MESSAGE)
    with_ten = source_hash()
    monkeypatch.setattr(messages, "MATH_ERROR", messages.Message(66, "Math error"))
    assert "return -66LL if n else n.real" in joined(tmp_path, monkeypatch, MESSAGE)
    assert source_hash() != with_ten


def test_a_message_without_a_row_cannot_be_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = MESSAGE.replace("MATH_ERROR", "MATHS_ERROR")
    with pytest.raises(UnityError, match=r"messages\.MATHS_ERROR is not"):
        joined(tmp_path, monkeypatch, text)


ROWS = "from openacr.map.words import mf1\nfrom openacr.map.rows import axes, kernel\n"


def place_in_c(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, head: str = ROWS
) -> str:
    """What is compiled of a place in the state."""
    code = f"def f(F: F64, n: int) -> float:\n    return F[{place}]\n"
    text = joined(tmp_path, monkeypatch, head + code)
    return text[text.index("return F[") + len("return F[") : text.rindex("]")]


def test_a_place_in_a_row_is_the_first_place_and_a_distance(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = axes.jog_cnt[:2]
    distance = f"{second - first}LL"
    assert place_in_c(tmp_path, monkeypatch, "axes.jog_cnt[n]") == f"{first}LL + n * {distance}"
    other = place_in_c(tmp_path, monkeypatch, "axes.jog_cnt[16 + n] + 3")
    assert other == f"{first}LL + (16LL + n) * {distance} + 3LL"


def test_places_that_follow_each_other_are_not_multiplied(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = "from openacr.map.words import mf3\n"
    assert place_in_c(tmp_path, monkeypatch, "mf3.word[n]", head) == "4256LL + n"


def test_places_of_a_range_are_its_first_one_and_the_index(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = "from openacr.cnc.rows import scans\n"
    first = scans.word.start
    assert place_in_c(tmp_path, monkeypatch, "scans.word[n + 1]", head) == f"{first}LL + (n + 1LL)"
    assert place_in_c(tmp_path, monkeypatch, "scans.value", head) == f"{scans.value}LL"


def test_a_row_in_two_runs_asks_which(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = "4112LL + n if n < 8LL else 4320LL + n"
    assert place_in_c(tmp_path, monkeypatch, "mf1.word[n]") == expected
    head = "from openacr.map.rows import encoders\n"
    expected = "6144LL + n * 16LL if n < 16LL else 24320LL + n * 16LL"
    assert place_in_c(tmp_path, monkeypatch, "encoders.encoder_position[n]", head) == expected


def test_the_place_and_the_numbers_of_a_family_are_literals(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert place_in_c(tmp_path, monkeypatch, "kernel.synced") == f"{kernel.synced}LL"
    assert place_in_c(tmp_path, monkeypatch, "axes.COUNT + mf1.IN_MOTION") == "16LL + 16LL"
    head = "from openacr.map.rows import axes as a\nBOTH = a.COUNT | 64\n"
    assert place_in_c(tmp_path, monkeypatch, "BOTH", head) == "80LL"


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("mf1.word[n + 1]", "an index into a row of two runs has to be a name"),
        ("candi.word[n]", "the places of the row lie in more than two runs"),
    ],
)
def test_places_that_cannot_be_computed_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, message: str
) -> None:
    assert candi.word[16] != candi.word[15] + 1  # words in four runs
    head = "from openacr.map.words import candi, mf1\n"
    with pytest.raises(UnityError, match=re.escape(message)):
        place_in_c(tmp_path, monkeypatch, place, head)


def test_views_of_two_buffers_are_refused() -> None:
    if not compiled.is_compiled:
        pytest.skip("nothing is compiled")
    one, other = Memory(), Memory()
    with pytest.raises(ValueError, match="two buffers"):
        compiled.counterpart(tick)(one.F, one.I, other.S)


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("def f(n: int) -> int:\n    return n // 2\n", "//, % and ** differ between builds"),
        ("def f(n: int) -> int:\n    n //= 2\n    return n\n", "//, % and ** differ"),
        ("def f(n: int) -> int:\n    return n % 2\n", "//, % and ** differ"),
        ("def f(n: float) -> float:\n    return n**2\n", "//, % and ** differ"),
        ("def f(n) -> int:\n    return 1\n", "every argument and result needs a simple type"),
        ("def f(n: str) -> int:\n    return 1\n", "every argument and result needs a simple type"),
        (
            "def f(F: F64) -> None:\n    F[0] = 1.0\n"
            "def g(F: F64, other: F64) -> None:\n    f(other)\n",
            "has to get F, I and S as they are",
        ),
        ("class A:\n    pass\n", "only functions and constants are compiled"),
        ("from os import path\n", "import of os cannot be compiled"),
        ("from openacr import errors\n", "import of openacr cannot be compiled"),
        ("from openacr import messages, errors\n", "import of openacr cannot be compiled"),
        ("def f() -> None:\n    pass\n\n\ndef f() -> None:\n    pass\n", "f is defined twice"),
    ],
)
def test_what_could_differ_between_the_builds_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, message: str
) -> None:
    with pytest.raises(UnityError, match=message.replace("*", r"\*")):
        joined(tmp_path, monkeypatch, code)
