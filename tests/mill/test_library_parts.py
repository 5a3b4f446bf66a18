"""Library parts on the virtual machine, by the same commands as any other program."""

import pytest
from tests.mill.shop import Shop

from openacr.cnc.parts.library import part_named, prepared
from openacr.mill.run.lifecycle import Options, State


def triangle(shop: Shop) -> str:
    sizes = {200: 1.0, 201: 1.0, 202: 0.2, 220: 0.1, 221: 0.1}
    return prepared(part_named("triangle"), sizes, shop.store, is_metric=False, feed=300).program


@pytest.mark.req("MILL-LIB-RUN")
def test_a_part_runs_from_the_zero_in_use_by_run_dry_run_block_and_stop() -> None:
    shop = Shop(P910=2.0, P911=1.0)  # G54
    text = triangle(shop)
    shop.run_text(text)
    assert shop.place() == pytest.approx((2.0, 1.0, 0.1))
    whole = [(x, y) for x, y, z in shop.path if z < -0.05]
    assert max(x for x, _ in whole) == pytest.approx(2.0 + 0.26 + 1.0, abs=0.05)
    assert shop.run_text(text, Options(is_dry=True)) > 0
    assert shop.place() == pytest.approx((2.0, 1.0, 0.1))
    shop.load(text, Options(is_single=True))
    assert shop.until(State.HOLD) is State.HOLD
    shop.runner.block(False)
    shop.runner.start()
    shop.pass_time(0.3)
    shop.runner.stop()
    assert shop.until(State.PAUSED) is State.PAUSED
    shop.pass_time(0.5)
    here = shop.place()
    shop.pass_time(0.3)
    assert shop.place() == here
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.place() == pytest.approx((2.0, 1.0, 0.1))
