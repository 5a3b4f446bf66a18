"""The end of a session of the debugger, whatever interrupts it."""

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO

import pytest

from openacr.debugger.adapter import Adapter
from openacr.debugger.server import serve


@pytest.mark.parametrize("too_early", [0, 1])
def test_an_interrupt_before_it_is_kept_out_keeps_nothing_from_its_end(
    monkeypatch: pytest.MonkeyPatch, too_early: int
) -> None:
    closed = []
    monkeypatch.setattr(Adapter, "close", lambda adapter: closed.append(adapter))
    interrupts = [KeyboardInterrupt] * too_early

    @contextmanager
    def ending() -> Iterator[None]:
        if interrupts:
            raise interrupts.pop()
        yield

    if too_early:
        with pytest.raises(KeyboardInterrupt):
            serve(BytesIO(), BytesIO(), ending)
    else:
        serve(BytesIO(), BytesIO(), ending)
    assert len(closed) == 1
