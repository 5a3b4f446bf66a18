"""What the first key in a file would wait for is read ahead, in steps."""

import asyncio
import time
from pathlib import Path
from typing import Any

import pytest

from openacr.editing.controller import facts as of_controllers
from openacr.editing.controller import language
from openacr.editing.document import Place
from openacr.editing.engine import Engine
from openacr.editing.languages import STEP_LINES
from openacr.editing.part_programs import facts as of_part_programs
from openacr.language_server import server as language_server
from openacr.map import flag_names, parameter_names

FILES: list[tuple[str, str, Any]] = [
    ("prog0.8k", "X{}.5", of_controllers.facts_of), ("a.nc", "G1 X{}.5", of_part_programs.facts_of),
]  # fmt: skip
PATIENCE_S = 60.0


@pytest.mark.parametrize(("name", "line", "facts_of"), FILES)
def test_the_first_key_reads_no_line_but_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, line: str, facts_of: Any
) -> None:
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "store.db"))
    engine, path = Engine(), tmp_path / name
    engine.open(path, "\n".join(map(line.format, range(2 * STEP_LINES + 1))))
    for read in (facts_of, parameter_names, flag_names):
        read.cache_clear()
    seen = [facts_of.cache_info().currsize for _ in engine.prepare(path)]
    assert seen[-3:] == [STEP_LINES, 2 * STEP_LINES, 2 * STEP_LINES + 1]
    assert seen[-4] == 0
    monkeypatch.setattr(language, "outline", None)  # there is one
    engine.complete(path, Place(0, 2))
    list(engine.entries(path))
    assert facts_of.cache_info().misses == 2 * STEP_LINES + 1
    if name == "prog0.8k":
        assert (parameter_names.cache_info().currsize, flag_names.cache_info().currsize) == (1, 1)


def test_a_file_may_be_closed_while_it_is_read_ahead(tmp_path: Path) -> None:
    engine, path = Engine(), tmp_path / "prog0.8k"
    engine.open(path, "X1\n" * 2 * STEP_LINES)
    reading = engine.prepare(path)
    next(reading)
    engine.close(path)
    list(reading)
    assert list(engine.prepare(path)) == []


def test_a_server_reads_ahead_in_a_file_that_is_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(language_server, "PREPARE_S", 0.0)
    server = language_server.Server(tmp_path / "store.db")
    monkeypatch.setattr(server, "publish", lambda *found: None)
    asked: list[Path] = []

    def prepare(path: Path) -> Any:
        asked.append(path)
        yield from (None, None)
        asked.append(path)

    monkeypatch.setattr(server.engine, "prepare", prepare)
    path = tmp_path / "prog0.8k"

    async def work() -> None:
        from lsprotocol import types

        server.opened(types.TextDocumentItem(path.as_uri(), "acrobasic", 1, ""))
        end_s = time.monotonic() + PATIENCE_S
        while len(asked) < 2:
            assert time.monotonic() < end_s
            await asyncio.sleep(0.005)

    asyncio.run(work())
    assert asked == [path, path]
