"""Bundled libraries of the screens are what the lock file and the script make of them.

Hashes are compared, so no Node is needed; `make web-bundle` writes both sides anew.
"""

import gzip
import hashlib
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "web-bundle"
VENDOR = ROOT / "src/openacr/panel/web/vendor"
MANIFEST = json.loads((VENDOR / "manifest.json").read_text(encoding="utf-8"))
LIBRARIES = [
    "codemirror.js", "dockview.css", "dockview.js", "three.js", "uplot.css", "uplot.js",
    "xterm.css", "xterm.js",
]  # fmt: skip


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_every_input_is_the_one_the_bundle_was_made_from() -> None:
    names = ["package.json", "package-lock.json", "bundle.mjs"]
    for folder in ("entries", "types"):
        names += sorted(f"{folder}/{each.name}" for each in (SOURCES / folder).iterdir())
    assert {name: sha256(SOURCES / name) for name in names} == MANIFEST["inputs"]


def test_every_output_is_the_one_the_script_wrote() -> None:
    files = [each for each in VENDOR.rglob("*") if each.is_file() and each.name != "manifest.json"]
    written = {each.relative_to(VENDOR).as_posix(): sha256(each) for each in files}
    assert written == MANIFEST["outputs"]


@pytest.mark.parametrize("name", LIBRARIES)
def test_every_library_has_a_compressed_sibling(name: str) -> None:
    packed = (VENDOR / f"{name}.gz").read_bytes()
    assert gzip.decompress(packed) == (VENDOR / name).read_bytes()


def test_every_bundled_package_is_locked_in_this_version_and_has_its_licence() -> None:
    lock = json.loads((SOURCES / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    locked = {name: lock[f"node_modules/{name}"]["version"] for name in MANIFEST["packages"]}
    assert locked == MANIFEST["packages"]
    licences = {each.name for each in (VENDOR / "licenses").iterdir()}
    assert licences == {f"{name.replace('/', '__')}.txt" for name in MANIFEST["packages"]}


def test_the_lock_file_names_no_registry() -> None:
    lock = json.loads((SOURCES / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    assert [name for name, each in lock.items() if "resolved" in each] == []
    assert [name for name, each in lock.items() if name and not each.get("integrity")] == []
