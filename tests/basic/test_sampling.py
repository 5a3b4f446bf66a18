"""The sampler: channels, trigger, period, modes, and its end."""

from tests.basic.motion_bench import Bench

INDEX, TRIGGER_INDEX = 6912, 6913
ARMED, RUNNING, MODE = 104, 105, 106


def bench(count: int, *lines: str) -> Bench:
    """Channel 0 records P38912 into LA0."""
    made = Bench("X").all("DIM LA(2)", f"DIM LA0({count})", "DIM SA(1)", "DIM SA0(4)")
    made.all("DIM DA(1)", "DIM DA0(4)")
    return made.all("SAMP 0 SRC P38912", "SAMP 0 BASE LA0", *lines)


def live(made: Bench, *values: int) -> Bench:
    for value in values:
        made.memory.I[38912] = value
        made.ticks(1)
    return made


def array(made: Bench, name: str, count: int) -> list[float]:
    return [float(made.type(f"?{name}({place})")) for place in range(count)]


def test_the_trigger_is_waited_for() -> None:
    made = bench(3, "SAMP TRG -BIT128", "SET 128", f"SET {ARMED}")
    live(made, 1, 2)
    assert (made.bit(RUNNING), made.p(INDEX)) == (False, 0)
    made.all("CLR 128")
    live(made, 3)
    made.all("SET 128")
    live(made, 4, 5)
    assert array(made, "LA0", 3) == [3, 4, 5]


def test_with_mode_select_it_records_only_while_the_trigger_holds() -> None:
    made = bench(4, "SAMP TRG 128", f"SET {MODE} {ARMED}", "SET 128")
    live(made, 1, 2)
    made.all("CLR 128")
    live(made, 3, 4)
    assert (made.bit(RUNNING), made.bit(ARMED)) == (False, True)
    made.all("SET 128")
    live(made, 5)
    assert made.p(TRIGGER_INDEX) == 2
    live(made, 6)
    assert array(made, "LA0", 4) == [1, 2, 5, 6]
    assert not made.bit(ARMED)


def test_the_shortest_of_several_arrays_ends_it() -> None:
    made = bench(9, "SAMP 1 SRC P12348", "SAMP 1 BASE SA0", "SAMP 2 SRC P38912")
    made.all("SAMP 2 BASE DA0", "JOG VEL X2.5", f"SET {ARMED}")
    live(made, 1, 2, 3, 4, 5)
    assert made.p(INDEX) == 4
    assert array(made, "SA0", 4) == [2.5] * 4
    assert array(made, "DA0", 4) == [1, 2, 3, 4]


def test_arming_again_begins_again() -> None:
    made = bench(2, f"SET {ARMED}")
    live(made, 1, 2, 3)
    made.all(f"SET {ARMED}")
    live(made, 8, 9)
    assert array(made, "LA0", 2) == [8, 9]


def test_arrays_that_are_freed_end_it() -> None:
    made = bench(9, f"SET {ARMED}")
    live(made, 1, 2)
    made.all("CLEAR")
    live(made, 3)
    assert [made.bit(flag) for flag in (ARMED, RUNNING)] == [False, False]


def test_report_and_clear() -> None:
    made = bench(9, "SAMP TRG -BIT128", "SAMP PERIOD 0.01")
    assert made.type("SAMP") == (
        "SAMP TRG -BIT128|SAMP PERIOD 0.01|SAMP 0 SRC P38912|SAMP 0 BASE LA0"
    )
    made.all("SAMP CLEAR")
    assert made.type("SAMP") == "SAMP PERIOD 0"
    assert made.type("SAMP 8 SRC P38912") == "Invalid argument"
    assert made.type("SAMP 0 SRC P40000") == "Invalid parameter"
    assert made.type("SAMP 0 BASE LA7") == "Undefined variable"
