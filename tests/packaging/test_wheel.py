"""The wheel works without the source tree: examples, first projects, the panel's files."""

import os
import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = (
    "src", "editors", "examples", "parts", "conformance", "pyproject.toml", "setup.py",
    "MANIFEST.in", "README.md", "LICENSE",
)  # fmt: skip


def pip(*words: object) -> None:
    """The time of the commit that docs/releasing.md gives a build is any fixed time here."""
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q", *map(str, words)]
    environment = {"OPENACR_PURE": "1", "SOURCE_DATE_EPOCH": "1700000000"}
    subprocess.run(command, check=True, env=os.environ | environment)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel without a compiled core, built from a copy of the sources."""
    tree = tmp_path_factory.mktemp("tree")
    for name in SOURCES:
        if (ROOT / name).is_dir():
            ignored = shutil.ignore_patterns("__pycache__", "*.so", "*.egg-info")
            shutil.copytree(ROOT / name, tree / name, ignore=ignored)
        else:
            shutil.copyfile(ROOT / name, tree / name)
    pip("wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", tree / "dist", tree)
    (built,) = (tree / "dist").glob("openacr-*.whl")
    return built


@pytest.fixture(scope="module")
def python(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fresh environment with the wheel; other packages are those of the tests."""
    folder = tmp_path_factory.mktemp("fresh") / "env"
    venv.create(folder, with_pip=False, symlinks=os.name != "nt")
    found = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    pip("--python", found, "install", "--no-deps", "--no-index", wheel)
    (site,) = folder.rglob("site-packages")
    (site / "others.pth").write_text(os.path.dirname(os.path.dirname(pytest.__file__)))
    return found


def openacr(python: Path, folder: Path, *words: str) -> str:
    """What a command of the installed package prints; it must end with 0."""
    command = [str(python), "-I", "-m", "openacr", *words]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_the_wheel_holds_examples_templates_and_screens_and_no_other_top_level_name(
    wheel: Path,
) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert wheel.name.endswith("-py3-none-any.whl")
    assert {name.split("/")[0] for name in names} == {"openacr", "openacr-0.1.0.dist-info"}
    example = "openacr/example_projects"
    for path in (*(ROOT / "examples").rglob("*.*"), *(ROOT / "parts").glob("*.*")):
        assert f"{example}/{path.parent.name}/{path.name}" in names
    cases = ROOT / "conformance"
    for path in [*cases.rglob("*.txt"), *cases.rglob("*.8k")]:
        assert f"openacr/conformance/{path.relative_to(cases)}" in names
    assert "openacr/conformance/conftest.py" not in names
    templates = ROOT / "src" / "openacr" / "starter" / "templates"
    for path in templates.iterdir():
        assert f"openacr/starter/templates/{path.name}" in names
    assert "openacr/panel/web/index.html" in names


def test_a_wheel_that_is_built_again_is_the_same_to_the_byte(wheel: Path, tmp_path: Path) -> None:
    tree = wheel.parents[1]
    for path in tree.rglob("*.py"):
        os.utime(path, (1600000000, 1600000000))
    pip("wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", tmp_path, tree)
    assert (tmp_path / wheel.name).read_bytes() == wheel.read_bytes()


def test_it_works_from_an_empty_folder_without_the_sources(python: Path, tmp_path: Path) -> None:
    place = [str(python), "-I", "-c", "import openacr; print(openacr.__file__)"]
    found = subprocess.run(place, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert Path(found.strip()).is_relative_to(python.parents[1])
    listed = openacr(python, tmp_path, "examples")
    assert "square            Square: buffered moves" in listed
    openacr(python, tmp_path, "examples", "copy", "gear_box", "mine")
    openacr(python, tmp_path, "run", "mine", "--for", "0.01", "--scenario", empty(tmp_path))
    openacr(python, tmp_path, "new", "turntable", "--kind", "turntable")
    assert openacr(python, tmp_path, "check", "turntable") == "turntable: no errors\n"


def empty(folder: Path) -> str:
    """A scenario that does nothing: a few ticks are enough to see that everything is there."""
    path = folder / "nothing.toml"
    path.write_text("duration_s = 0.01\n")
    return str(path)
