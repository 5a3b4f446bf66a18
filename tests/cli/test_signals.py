"""A polite kill ends a command as Ctrl-C does; what is ignored stays ignored."""

import asyncio
import os
import signal
import sys

import pytest

from openacr.cli.signals import endings, stop_on_signals, terminations_as_interrupts

if sys.platform == "win32":
    pytest.skip("signals of POSIX", allow_module_level=True)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_termination_is_an_interrupt(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with pytest.raises(KeyboardInterrupt), terminations_as_interrupts():
        os.kill(os.getpid(), number)
    assert signal.getsignal(number) is before


def test_a_second_termination_does_not_interrupt_the_cleanup_of_the_first() -> None:
    before, done = signal.getsignal(signal.SIGTERM), ""
    with pytest.raises(KeyboardInterrupt), terminations_as_interrupts():
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            signal.raise_signal(signal.SIGTERM)
            done = "all"
    assert done == "all"
    assert signal.getsignal(signal.SIGTERM) is before


def test_a_hang_up_that_nohup_has_ignored_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with terminations_as_interrupts():
            os.kill(os.getpid(), signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_server_stops_on_a_termination() -> None:
    async def run() -> None:
        stop = asyncio.Event()
        stop_on_signals(stop.set)
        os.kill(os.getpid(), signal.SIGTERM)
        await asyncio.wait_for(stop.wait(), 60)

    asyncio.run(run())


def test_where_a_loop_takes_no_signals_a_handler_of_python_stops_the_server(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As on Windows, where Ctrl-Break is a signal of its own."""

    def refused(self: object, number: int, callback: object) -> None:
        raise NotImplementedError

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, *endings())}
    monkeypatch.setattr(asyncio.SelectorEventLoop, "add_signal_handler", refused)
    monkeypatch.setattr(signal, "SIGBREAK", signal.SIGUSR1, raising=False)
    before[signal.SIGUSR1] = signal.getsignal(signal.SIGUSR1)

    async def run() -> None:
        stop = asyncio.Event()
        stop_on_signals(stop.set)
        os.kill(os.getpid(), signal.SIGUSR1)
        await asyncio.wait_for(stop.wait(), 60)

    try:
        asyncio.run(run())
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def test_a_system_without_hang_ups_has_the_other_endings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(signal, "SIGHUP")
    assert endings() == [signal.SIGTERM]
