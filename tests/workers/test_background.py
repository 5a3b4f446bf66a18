"""A process beside a server: what waits for it learns of its end."""

import asyncio
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest
from tests.panel.bench import is_alive
from tests.workers.orphans import is_there, left_by

from openacr.errors import UserError
from openacr.workers.background import ENDED, Background, result_of

NAP_S = 120.0


def test_work_is_refused_when_its_process_is_killed_also_beside_work_that_was_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    failures: list[threading.ExceptHookArgs] = []
    monkeypatch.setattr(threading, "excepthook", failures.append)
    pool = Background("killed")

    async def killed() -> list[BaseException | None]:
        process = await pool.run(os.getpid)
        naps = [asyncio.create_task(pool.run(time.sleep, NAP_S)) for _ in range(8)]
        await asyncio.sleep(0)
        for nap in naps[4:]:
            nap.cancel()
        await asyncio.wait(naps[4:])
        os.kill(process, signal.SIGTERM)
        async with asyncio.timeout(NAP_S / 2):
            return await asyncio.gather(*naps, return_exceptions=True)

    ends = asyncio.run(killed())
    pool.close()
    assert [type(end) for end in ends] == 4 * [UserError] + 4 * [asyncio.CancelledError]
    assert failures == []


def test_work_whose_process_is_still_starting_is_refused_when_its_pool_is_closed() -> None:
    pool = Background("killed")

    async def closed() -> list[BaseException | None]:
        naps = [asyncio.create_task(pool.run(time.sleep, NAP_S)) for _ in range(8)]
        await asyncio.sleep(0)
        pool.close()
        async with asyncio.timeout(NAP_S / 2):
            return await asyncio.gather(*naps, return_exceptions=True)

    assert [str(end) for end in asyncio.run(closed())] == 8 * [ENDED]


def test_a_pool_that_was_closed_works_again_and_one_that_has_ended_does_not() -> None:
    pool = Background("killed")
    pool.close()
    assert asyncio.run(pool.run(abs, -3)) == 3
    pool.end()
    with pytest.raises(UserError, match="server ends"):
        asyncio.run(pool.run(abs, -3))


def test_a_process_that_was_killed_while_it_was_idle_is_started_again() -> None:
    pool = Background("killed")

    async def process() -> int:
        return await pool.run(os.getpid)

    first = asyncio.run(process())
    os.kill(first, signal.SIGTERM)
    end_s = time.monotonic() + NAP_S
    while is_alive(first):
        assert time.monotonic() < end_s
        time.sleep(0.01)
    try:
        second = asyncio.run(process())
    except UserError as error:  # the executor had not yet learned of the end
        assert str(error) == "killed"
        second = asyncio.run(process())
    assert second != first
    pool.end()


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="processes cannot be stopped")
def test_a_process_that_is_frozen_with_work_on_its_line_is_replaced_when_it_is_closed() -> None:
    pool = Background("killed")

    async def replaced() -> tuple[int, BaseException | None, int]:
        first = await pool.run(os.getpid)
        os.kill(first, signal.SIGSTOP)
        frozen = asyncio.create_task(pool.run(len, bytes(10_000_000)))  # more than a pipe holds
        await asyncio.sleep(0)
        pool.close()
        async with asyncio.timeout(NAP_S / 2):
            (end,) = await asyncio.gather(frozen, return_exceptions=True)
            return first, end, await pool.run(os.getpid)  # type: ignore[return-value]

    first, end, second = asyncio.run(replaced())
    pool.end()
    assert (str(end), first != second) == (ENDED, True)
    assert not is_there(first)


def test_the_error_of_work_whose_process_dies_is_the_given_one() -> None:
    pool = Background("the file is too long")
    with pytest.raises(UserError, match="the file is too long"):
        asyncio.run(pool.run(os._exit, 3))
    pool.end()


def test_what_work_prints_is_not_on_the_output_of_its_server() -> None:
    code = """
        import asyncio, os
        from openacr.workers import Background
        if __name__ == "__main__":
            process = Background("killed")
            print(asyncio.run(process.run(os.write, 1, b"a word of a library")))
            process.end()
    """
    command = [sys.executable, "-c", textwrap.dedent(code)]
    done = subprocess.run(command, check=True, capture_output=True, timeout=NAP_S)
    assert (done.stdout, done.stderr) == (b"19\n", b"a word of a library")


def test_a_task_that_was_cancelled_with_its_pool_is_refused() -> None:
    async def cancelled() -> None:
        task = asyncio.create_task(asyncio.sleep(NAP_S))
        task.cancel()
        await asyncio.wait((task,))
        with pytest.raises(UserError, match=ENDED):
            result_of(task)

    asyncio.run(cancelled())


@pytest.mark.skipif(sys.platform == "win32", reason="processes are looked up in /proc")
def test_the_process_ends_with_a_server_that_is_killed_idle_or_at_work() -> None:
    children = left_by(
        """
        import asyncio, os, time
        from openacr.workers import Background
        async def main():
            idle, busy = Background("killed"), Background("killed")
            found = [await each.run(os.getpid) for each in (idle, busy)]
            nap = asyncio.create_task(busy.run(time.sleep, 60))
            await asyncio.sleep(0)
            print(*found, flush=True)
            await nap
        if __name__ == "__main__":
            asyncio.run(main())
        """
    )
    assert len(children) == 2
