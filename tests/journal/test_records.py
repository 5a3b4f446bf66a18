"""Records of journal files: written whole and in order, also on a disk that gets full."""

import io

import pytest

from openacr.journal.entries import MAGIC
from openacr.journal.records import Records

FULL = OSError(28, "No space left on device")


class Small(io.BytesIO):
    """A disk with some bytes left, of which a write takes 10 at most."""

    def __init__(self, most_bytes: int) -> None:
        super().__init__()
        self.most_bytes = most_bytes

    def write(self, data: bytes, /) -> int:  # type: ignore[override]
        free = self.most_bytes - self.tell()
        if not free:
            raise FULL
        return super().write(data[: min(free, 10)])


@pytest.mark.parametrize(
    ("most_bytes", "count"), [(6, 0), (7, 1), (10, 1), (11, 2), (14, 2), (15, 3)]
)
def test_of_records_that_are_written_together_the_whole_ones_are_kept(
    most_bytes: int, count: int
) -> None:
    begin = MAGIC + b"{}\n"
    file, failures = Small(len(begin) + most_bytes), list[OSError]()
    records = Records(file, failures.append, b"{}\n")
    written = (b"[1, 2]\n", b"[3]\n", b"[4]\n")
    for record in written:
        records.put(record)
    assert file.getvalue() == begin
    records.flush()
    assert file.getvalue() == begin + b"".join(written[:count])
    assert failures == ([] if count == 3 else [FULL])
    for _ in range(2):  # nothing more is written, and the failure is reported once
        records.put(b"[5]\n")
        records.flush()
    assert file.getvalue() == begin + b"".join(written[:count])
    assert failures == [FULL]
    assert records.failure is FULL


def test_a_file_that_cannot_be_begun_is_an_error() -> None:
    file, failures = Small(len(MAGIC)), list[OSError]()
    with pytest.raises(OSError, match="No space left"):
        Records(file, failures.append, b"{}\n")
    assert failures == []
