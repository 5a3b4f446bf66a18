"""The process that reads programs for the screens: what waits for it learns of its end."""

import asyncio
import os
import signal
import sys
import threading
import time

import pytest
from tests.panel.bench import is_alive
from tests.workers.orphans import left_by

from openacr.errors import UserError
from openacr.panel.work.pool import ENDED, Pool, result_of

NAP_S = 120.0


def test_work_is_refused_when_its_process_is_killed_also_beside_work_that_was_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    failures: list[threading.ExceptHookArgs] = []
    monkeypatch.setattr(threading, "excepthook", failures.append)
    pool = Pool()

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
    pool = Pool()

    async def closed() -> list[BaseException | None]:
        naps = [asyncio.create_task(pool.run(time.sleep, NAP_S)) for _ in range(8)]
        await asyncio.sleep(0)
        pool.close()
        async with asyncio.timeout(NAP_S / 2):
            return await asyncio.gather(*naps, return_exceptions=True)

    assert [str(end) for end in asyncio.run(closed())] == 8 * [ENDED]


def test_a_pool_that_was_closed_works_again_and_one_that_has_ended_does_not() -> None:
    pool = Pool()
    pool.close()
    assert asyncio.run(pool.run(abs, -3)) == 3
    pool.end()
    with pytest.raises(UserError, match="server ends"):
        asyncio.run(pool.run(abs, -3))


def test_a_process_that_was_killed_while_it_was_idle_is_started_again() -> None:
    pool = Pool()

    async def process() -> int:
        return await pool.run(os.getpid)

    first = asyncio.run(process())
    os.kill(first, signal.SIGTERM)
    end_s = time.monotonic() + NAP_S
    while is_alive(first):
        assert time.monotonic() < end_s
        time.sleep(0.01)
    assert asyncio.run(process()) != first
    pool.end()


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
        from openacr.panel.work.pool import Pool
        async def main():
            idle, busy = Pool(), Pool()
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
