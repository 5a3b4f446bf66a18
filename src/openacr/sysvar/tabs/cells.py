"""The cells of programs in the store, P100 to P4095.

Cells 0 to 99 are variables of the card and have no row here. Lengths are in default units;
P101..P108 and the cells of canned cycles are in the active unit and therefore have no unit here.
"""

from openacr.sysvar.schema import At, Tab
from openacr.sysvar.tabs.motion import HOME

RADIUS_OFFSETS, LENGTH_OFFSETS = 400, 999


def _home_preset(at: At) -> float:
    return at.read(HOME.preset[at.axis])


_TAB = Tab("CELLS", 0)
_CYCLE = {"doc": "Set by canned cycles, active unit."}


def _work_system(k: int) -> range:
    code = f"G{53 + k}" if k < 7 else f"G59.{k - 6}"
    return _TAB.by_axis.real(900 + 10 * k, f"Work system {k}", "u", doc=f"Offset of {code}.")


def _turn(cell: int, k: int) -> int:
    code = f"G{53 + k}" if k < 7 else f"G59.{k - 6}"
    return _TAB.real(
        cell, f"Work system {k} rotation", "deg", doc=f"{code} about Z, + from X to Y."
    )


def _offsets(base: int, name: str, count: int, doc: str) -> range:
    """A table of offsets by their numbers: 0 is always 0, the others are tools."""
    _TAB.real(base, f"{name} 0", "u", is_fixed=True, doc="Always 0.")
    _TAB.series(count, first=1).real(base + 1, f"{name} {{}}", "u", doc=doc)
    return range(base, base + 1 + count)


class CELLS:
    """Variables, offsets and state of programs."""

    tab = _TAB
    first_global = tab.real(100, "Global 100", "", doc="Free for programs.")
    g31_trip = tab.by_axis.real(101, "G31 trip", "", doc="Machine position, active unit.")
    tab.series(91, first=109).real(109, "Global {}", "", doc="Free for programs.")
    user_variables = tab.series(34, first=200).real(
        200, "User variable {}", "", doc="Sizes of library parts."
    )

    tool_selected = tab.integer(234, "Tool selected", doc="Selected by T for the next M6.")
    tool_in_spindle = tab.integer(235, "Tool in spindle", doc="Loaded by the last M6.")
    d_number = tab.integer(236, "D number", doc="Number of the radius in use.")
    h_number = tab.integer(237, "H number", doc="Number of the length in use.")
    spindle_speed = tab.real(238, "S", "rpm", doc="Commanded spindle speed.")
    feed = tab.real(239, "F", "", doc="Feed, active units/min.")
    spindle_state = tab.integer(
        240, "Spindle state", 5, doc="3 clockwise, 4 counter-clockwise, 5 off."
    )
    coolant_state = tab.integer(241, "Coolant state", doc="1 mist + 2 flood.")
    unit = tab.integer(242, "Unit", 20, doc="20 inch, 21 mm.")
    executing_line = tab.integer(243, "Executing line", doc="Line of the running program.")
    run_state = tab.choice(
        244,
        "Run state",
        {0: "idle", 1: "run", 2: "paused", 3: "wait", 4: "stop", 5: "alarm"},
        doc="State of the run.",
    )
    parts_finished = tab.real(245, "Parts finished", "", doc="Parts finished by Repeat Forever.")
    last_alarm = tab.integer(246, "Last alarm", doc="Code of the alarm.")
    fov_percent = tab.real(247, "FOV percent", "%", doc="Feed override in use.")
    run_time = tab.real(248, "Run time", "s", doc="Time of this run by the card's clock.")

    cycle_code = tab.integer(249, "Cycle code", doc="73..89, 0: no cycle.")
    cycle_hole_first_axis = tab.real(250, "Cycle hole, first axis", "", **_CYCLE)
    cycle_hole_second_axis = tab.real(251, "Cycle hole, second axis", "", **_CYCLE)
    cycle_bottom = tab.real(252, "Cycle bottom", "", **_CYCLE)
    cycle_r_level = tab.real(253, "Cycle R level", "", **_CYCLE)
    cycle_initial_level = tab.real(254, "Cycle initial level", "", **_CYCLE)
    cycle_return_level = tab.real(255, "Cycle return level", "", **_CYCLE)
    cycle_q = tab.real(256, "Cycle Q", "", **_CYCLE)
    cycle_p_seconds = tab.real(257, "Cycle P seconds", "", **_CYCLE)
    cycle_f = tab.real(258, "Cycle F", "", **_CYCLE)
    cycle_l_left = tab.real(259, "Cycle L left", "", **_CYCLE)
    cycle_g73_retract = tab.real(260, "Cycle G73 retract", "", **_CYCLE)
    cycle_g83_clearance = tab.real(261, "Cycle G83 clearance", "", **_CYCLE)
    cycle_shift_first_axis = tab.real(262, "Cycle shift, first axis", "", **_CYCLE)
    cycle_shift_second_axis = tab.real(263, "Cycle shift, second axis", "", **_CYCLE)
    cycle_spindle_at_call = tab.real(264, "Cycle spindle at call", "", **_CYCLE)
    cycle_return_code = tab.real(265, "Cycle return code", "", **_CYCLE)
    cycle_plane = tab.real(266, "Cycle plane", "", **_CYCLE)
    cycle_distance_mode = tab.real(267, "Cycle distance mode", "", **_CYCLE)
    cycle_last_bottom = tab.real(268, "Cycle last bottom", "", **_CYCLE)
    cycle_next_bottom = tab.real(269, "Cycle next bottom", "", **_CYCLE)
    cycle_direction = tab.real(270, "Cycle direction", "", **_CYCLE)

    homed_axes = tab.integer(271, "Homed axes", low=0, high=255, doc="Bit mask of the homed axes.")
    tab.series(8, first=272).real(272, "Reserved {}", "", doc="Reserved.")

    reference_point_1 = tab.by_axis.real(
        280, "Reference point 1", "u", _home_preset, doc="Reference point of G27 and G28."
    )
    reference_point_2 = tab.by_axis.real(
        290, "Reference point 2", "u", doc="Reference point of G30."
    )
    reference_point_3 = tab.by_axis.real(
        300, "Reference point 3", "u", doc="Reference point of G30."
    )
    reference_point_4 = tab.by_axis.real(
        310, "Reference point 4", "u", doc="Reference point of G30."
    )
    for _k in (288, 298, 308, 318):
        tab.series(2, first=_k).real(_k, "Reserved {}", "", doc="Reserved.")
    intermediate_point = tab.by_axis.real(
        320, "Intermediate point", "u", doc="Last intermediate point of G28 or G30."
    )
    intermediate_mask = tab.integer(
        328,
        "Intermediate mask",
        low=0,
        high=255,
        doc="Bit mask of the axes that have an intermediate point.",
    )
    g31_tripped = tab.boolean(329, "G31 tripped", doc="Whether the last G31 tripped.")
    g31_program_position = tab.by_axis.real(
        330, "G31 program position", "u", doc="Program position of the last trip."
    )
    tab.series(62, first=338).real(338, "Reserved {}", "", doc="Reserved.")

    free = tab.series(400, first=400).real(
        400, "Free {}", "", doc="Free for programs, kept in the store."
    )
    floating_zero_active = tab.boolean(
        800, "Floating zero active", doc="Whether any shift is active."
    )
    floating_zero_shift = tab.by_axis.real(
        801, "Floating zero shift", "u", doc="Shift by G92 or SET ZERO."
    )
    floating_zero_word = tab.by_axis.real(
        809, "Floating zero word", "u", doc="Axis words of the last G92."
    )
    floating_zero_before = tab.by_axis.real(
        817, "Floating zero before", "u", doc="Shift before the last G92, to undo it."
    )
    floating_zero_position = tab.by_axis.real(
        825, "Floating zero position", "u", doc="Machine position at the last G92."
    )
    free_after_zero = tab.series(67, first=833).real(
        833, "Free {}", "", doc="Free for programs, kept in the store."
    )

    common_work_shift = tab.by_axis.real(
        900, "Common work shift", "u", doc="Shift of all work systems."
    )
    work_systems = tuple(_work_system(k) for k in range(1, 9))
    work_rotations = tuple(_turn(908 + 10 * k, k) for k in range(1, 9))
    local_shift = tab.by_axis.real(990, "Local shift", "u", doc="Shift by G52.")
    work_system_in_use = tab.integer(998, "Work system in use", 1, low=0, high=8, doc="0 = G53.")
    for _k in range(908, 999, 10):
        if _k in work_rotations:
            tab.real(_k + 1, f"Free {_k + 1}", "", doc="Free.")
        elif _k != 998:
            tab.series(2, first=_k).real(_k, "Free {}", "", doc="Free.")
    tab.real(999, "Free 999", "", doc="Free.")

    d_radius = _offsets(1000, "D radius", RADIUS_OFFSETS, "Cutter radius.")
    free_after_radius = tab.series(99, first=1401).real(
        1401, "Free {}", "", doc="Free for programs, kept in the store."
    )
    d_wear = _offsets(1500, "D wear", RADIUS_OFFSETS, "Wear of the radius.")
    free_after_radius_wear = tab.series(97, first=1901).real(
        1901, "Free {}", "", doc="Free for programs, kept in the store."
    )
    current_d_radius = tab.real(1998, "Current D radius", "u", doc="Set by D.")
    current_d_wear = tab.real(1999, "Current D wear", "u", doc="Set by D.")
    h_length = _offsets(2000, "H length", LENGTH_OFFSETS, "Tool length.")
    h_wear = _offsets(3000, "H wear", LENGTH_OFFSETS, "Wear of the length.")
    current_h_length = tab.real(4000, "Current H length", "u", doc="Set by H.")
    current_h_wear = tab.real(4001, "Current H wear", "u", doc="Set by H.")
    free_after_length = tab.series(94, first=4002).real(
        4002, "Free {}", "", doc="Free for programs, kept in the store."
    )
