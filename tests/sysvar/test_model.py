"""Any sequence of writes, groups, failures and reopenings against a plain dictionary."""

import shutil
import tempfile
from pathlib import Path

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule
from tests.search import examples

from openacr.sysvar import Store

CELLS = (101, 150, 1001, 2001, 4001, 650_002, 952_010)
NUMBERS = st.sampled_from(CELLS)
VALUES = st.floats(0.001, 1000, allow_nan=False)


class StoreMachine(RuleBasedStateMachine):
    """Two stores on one file, and what both of them have to say."""

    def __init__(self) -> None:
        super().__init__()
        self.folder = Path(tempfile.mkdtemp())
        self.path = self.folder / "s.db"
        self.stores = [Store(self.path), Store(self.path)]
        self.defaults = {n: self.stores[0].read(n) for n in CELLS}
        self.model: dict[int, float] = {}

    def teardown(self) -> None:
        for store in self.stores:
            store.close()
        shutil.rmtree(self.folder)

    @rule(which=st.integers(0, 1), n=NUMBERS, value=VALUES)
    def write(self, which: int, n: int, value: float) -> None:
        self.stores[which].write(n, value)
        self.model[n] = value

    @rule(which=st.integers(0, 1), n=NUMBERS)
    def reset(self, which: int, n: int) -> None:
        self.stores[which].reset(n)
        self.model.pop(n, None)

    @rule(
        which=st.integers(0, 1),
        changes=st.lists(st.tuples(NUMBERS, VALUES), max_size=5),
        fails=st.booleans(),
    )
    def group(self, which: int, changes: list[tuple[int, float]], fails: bool) -> None:
        store = self.stores[which]
        before = dict(self.model)
        try:
            with store.transaction(is_durable=False):
                for n, value in changes:
                    store.write(n, value)
                    assert store.read(n) == value
                if fails:
                    raise KeyError
        except KeyError:
            assert {n for n in CELLS if store.is_set(n)} == set(before)
        else:
            self.model.update(changes)

    @rule(which=st.integers(0, 1))
    def reopen(self, which: int) -> None:
        self.stores[which].close()
        self.stores[which] = Store(self.path)

    @rule(which=st.integers(0, 1), value=VALUES)
    def news(self, which: int, value: float) -> None:
        token = self.stores[1 - which].token
        old = self.stores[which].read(150)
        self.stores[which].write(150, value)
        was_news = old != value or 150 not in self.model
        self.model[150] = value
        assert self.stores[1 - which].changes_since(token).numbers == ({150} if was_news else set())

    @invariant()
    def both_say_the_same(self) -> None:
        wanted = {**self.defaults, **self.model}
        for store in self.stores:
            assert {n: store.read(n) for n in CELLS} == wanted
            assert {n for n in CELLS if store.is_set(n)} == set(self.model)


TestStore = StoreMachine.TestCase
TestStore.settings = settings(max_examples=examples(25), stateful_step_count=25, deadline=None)
