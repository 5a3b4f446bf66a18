"""Each case of the files here, and each row of its table, is a test."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from openacr.conform import Case, read, report, run
from openacr.errors import OpenacrError


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.File | None:
    if file_path.suffix != ".txt":
        return None
    found: pytest.File = CaseFile.from_parent(parent, path=file_path)
    return found


class CaseFile(pytest.File):
    def collect(self) -> Iterator[pytest.Item]:
        try:
            cases = read(self.path)
        except OpenacrError as error:
            yield FaultyFile.from_parent(self, name="the file can be read", error=error)
        else:
            for case in cases:
                yield CaseItem.from_parent(self, name=case.name, case=case)


class FaultyFile(pytest.Item):
    def __init__(self, *, error: OpenacrError, **rest: Any) -> None:
        super().__init__(**rest)
        self.error = error

    def runtest(self) -> None:
        pytest.fail(str(self.error), pytrace=False)


class CaseItem(pytest.Item):
    def __init__(self, *, case: Case, **rest: Any) -> None:
        super().__init__(**rest)
        self.case = case
        if case.proves:
            self.add_marker(pytest.mark.req(*(claim.id for claim in case.proves)))

    def runtest(self) -> None:
        difference = run(self.case)
        if difference is not None:
            pytest.fail(report(self.case, difference), pytrace=False)

    def reportinfo(self) -> tuple[Path, int, str]:
        return self.path, self.case.line - 1, self.name
