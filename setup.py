"""Build the optional compiled core; everything else is declared in pyproject.toml.

`OPENACR_REQUIRE_EXT=1` turns a failed build into an error, `OPENACR_CHECKED=1` builds
with bounds checks (for tests, slow), `OPENACR_PURE=1` skips the extension.
"""

import os
import platform
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).parent
sys.path.insert(0, str(ROOT / "src"))


def extensions() -> list[Extension]:
    """The one compiled module, or nothing where it is not wanted or Cython is absent."""
    if os.environ.get("OPENACR_PURE") == "1":
        return []
    try:
        from Cython.Build import cythonize
    except ImportError:
        if os.environ.get("OPENACR_REQUIRE_EXT") == "1":
            raise
        print("openacr: Cython is not installed, building without the compiled core")
        return []
    from openacr.unity import write_unity

    checked = os.environ.get("OPENACR_CHECKED") == "1"
    source = write_unity(ROOT / "build" / "unity" / "_compiled.pyx", checked=checked)
    windows = sys.platform == "win32"
    # Fused multiply-add would round once where plain Python rounds twice, and the views
    # alias one buffer: both flags keep the compiled core bit-identical to its source.
    # SSE4.1 (any x86-64 since 2008) makes rounding one instruction with the same result.
    # Lines for a debugger take a third of the time and four fifths of the file.
    flags = [] if windows else ["-O3", "-ffp-contract=off", "-fno-strict-aliasing", "-w"]
    flags += [] if windows else ["-fno-math-errno", "-g0"]
    if platform.machine() in ("x86_64", "AMD64") and not windows:
        flags.append("-msse4.1")
    # Compilers take `inline` as a wish, and refuse it for what is long and called from Python, too.
    always = [] if windows else [("CYTHON_INLINE", "inline __attribute__((always_inline, unused))")]
    module = Extension(
        "openacr._compiled",
        [str(source.relative_to(ROOT))],
        define_macros=always,
        extra_compile_args=flags,
    )
    modules = cythonize(
        [module],
        include_path=[str(ROOT / "src")],
        compiler_directives={
            "language_level": 3,
            "boundscheck": checked,
            "wraparound": False,
            "initializedcheck": False,
            "cdivision": True,
            "infer_types": True,
        },
        quiet=True,
    )
    for built in modules:  # cythonize() drops the flag
        built.optional = os.environ.get("OPENACR_REQUIRE_EXT") != "1"
    return list(modules)


class BuildWithExamples(build_py):
    """The package, and the examples and cases of the source tree as folders in it."""

    def run(self) -> None:
        """Copy the modules, then the rest; a tree built in place has it already."""
        super().run()
        if self.editable_mode:
            return
        for folder in [*sorted((ROOT / "examples").iterdir()), ROOT / "parts"]:
            self._copy(sorted(folder.iterdir()), folder.parent, "example_projects")
        cases = ROOT / "conformance"
        files = [*cases.rglob("*.txt"), *cases.rglob("*.8k"), *cases.rglob("*.toml")]
        self._copy(sorted(files), cases, "conformance")

    def _copy(self, files: list[Path], root: Path, name: str) -> None:
        """Copy files to their places in a folder of the package."""
        for path in files:
            place = Path(self.build_lib) / "openacr" / name / path.relative_to(root)
            self.mkpath(str(place.parent))
            self.copy_file(str(path), str(place))


setup(ext_modules=extensions(), cmdclass={"build_py": BuildWithExamples})
