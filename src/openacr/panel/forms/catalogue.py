"""All forms of the panel, by the menus of the guide."""

from openacr.panel.forms.form import Form, Group, axes_of, by_axis, listed, per_axis, whole
from openacr.panel.roles import Role
from openacr.sysvar import Store
from openacr.sysvar.tabs import (
    AXIS,
    CELLS,
    COMMUNICATIONS,
    COMPATIBILITY,
    CONTROL,
    DISPLAY,
    FOV,
    GENERAL,
    HOME,
    IO,
    JOG,
    MESSAGES,
    OFFSETS,
    PROBE,
    ROV,
    SERVO,
    SOV,
    SPEEDS,
    SPINDLE,
    TOOL,
)

SYSTEM, OFFSET, SETUP, PANEL = "SYS PARAM", "OFFSETS", "RUN SETUP", "DISPLAY"
_SECRET = frozenset({GENERAL.password_hash})
STARTS = (  # SET MODALS
    GENERAL.start_set_chosen,
    GENERAL.start_motion,
    GENERAL.start_plane,
    GENERAL.start_distance,
    GENERAL.start_unit,
    GENERAL.start_work_system,
    GENERAL.start_path_mode,
    GENERAL.start_return_level,
    GENERAL.start_ij,
)
_OF_SETUP = frozenset({*STARTS, GENERAL.cmp_rad, GENERAL.run_setup_feedrate})
_CONTROL = frozenset(CONTROL.tab.base + offset for offset in CONTROL.tab.cells)
_CONTROL_1 = frozenset(cell for cell in _CONTROL if cell < CONTROL.epsilon_for_compensation)


def _work(store: Store, _axis: int | None) -> list[Group]:
    """The common shift, the eight work systems, the local and the floating zero."""
    titles = ("Common shift", *(f"G{n}" for n in range(54, 60)), "G59.1", "G59.2")
    rows = zip(titles, (CELLS.common_work_shift, *CELLS.work_systems), strict=True)
    groups = by_axis(*rows)(store, None)
    return list(groups)


def _references(store: Store, _axis: int | None) -> list[Group]:
    points = (
        CELLS.reference_point_1,
        CELLS.reference_point_2,
        CELLS.reference_point_3,
        CELLS.reference_point_4,
    )
    rows = ((f"Reference point {n}", cells) for n, cells in enumerate(points, 1))
    return list(by_axis(*rows)(store, None))


def _fixtures(store: Store, _axis: int | None) -> list[Group]:
    """G101 to G199, axis by axis; their Z is a length, which the H offsets have."""
    axes = [axis for axis, name in axes_of(store) if name != "Z"]
    by_number = zip(*(OFFSETS.fixtures[axis] for axis in axes), strict=True)
    return [Group("", [cell for cells in by_number for cell in cells])]


def _messages(_store: Store, _axis: int | None) -> list[Group]:
    columns = (
        MESSAGES.defined, MESSAGES.text, MESSAGES.bit, MESSAGES.level, MESSAGES.text_colour,
        MESSAGES.back_colour, MESSAGES.size, MESSAGES.alarm,
    )  # fmt: skip
    return [Group(f"Message {n}", [column[n] for column in columns]) for n in range(32)]


def _buttons(_store: Store, _axis: int | None) -> list[Group]:
    columns = (
        OFFSETS.button_caption,
        OFFSETS.button_set_bit,
        OFFSETS.button_show_bit,
        OFFSETS.button_mode,
    )
    return [Group(f"Button {n}", [column[n] for column in columns]) for n in range(32)]


def _polarity(_store: Store, _axis: int | None) -> list[Group]:
    return [
        Group("Inputs", [CONTROL.input_inverted[n] for n in range(32)]),
        Group("Outputs", [CONTROL.output_inverted[n] for n in range(32, 64)]),
    ]


def _line_names(_store: Store, _axis: int | None) -> list[Group]:
    return [
        Group("Inputs", [OFFSETS.input_name[n] for n in range(32)]),
        Group("Outputs", [OFFSETS.output_name[n] for n in range(32, 64)]),
    ]


def _feeds(_store: Store, _axis: int | None) -> list[Group]:
    return [
        Group("", [GENERAL.run_setup_feedrate]),
        Group("Speeds", [SPEEDS.cut_speed, SPEEDS.trial_speed]),
    ]


FORMS: dict[str, Form] = {
    form.name: form
    for form in (
        Form("SERVO", "Servo", SYSTEM, Role.SERVICE, per_axis(SERVO.tab), is_per_axis=True),
        Form("AXES", "Axes", SYSTEM, Role.SERVICE, per_axis(AXIS.tab), is_per_axis=True),
        Form(
            "CONTROL", "Control, page 1", SYSTEM, Role.SERVICE,
            whole(CONTROL.tab, hidden=_CONTROL - _CONTROL_1),
        ),
        Form(
            "CONTROL2", "Control, page 2", SYSTEM, Role.SERVICE,
            whole(CONTROL.tab, hidden=_CONTROL_1),
        ),
        Form("POLARITY", "Control, page 3: polarity", SYSTEM, Role.SERVICE, _polarity),
        Form("HOME", "Home", SYSTEM, Role.SERVICE, per_axis(HOME.tab), is_per_axis=True),
        Form("JOG", "Jog", SYSTEM, Role.SERVICE, per_axis(JOG.tab), is_per_axis=True),
        Form("IO", "I/O", SYSTEM, Role.SERVICE, whole(IO.tab)),
        Form("FOV", "Feed override", SYSTEM, Role.SERVICE, whole(FOV.tab)),
        Form("ROV", "Rapid override", SYSTEM, Role.SERVICE, whole(ROV.tab)),
        Form("SOV", "Spindle override", SYSTEM, Role.SERVICE, whole(SOV.tab)),
        Form("PROBE", "Probe", SYSTEM, Role.SERVICE, whole(PROBE.tab)),
        Form("SPEEDS", "Speeds", SYSTEM, Role.SERVICE, whole(SPEEDS.tab)),
        Form("COMPATIBILITY", "Compatibility", SYSTEM, Role.SERVICE, whole(COMPATIBILITY.tab)),
        Form("COMMUNICATIONS", "Communications", SYSTEM, Role.SERVICE, whole(COMMUNICATIONS.tab)),
        Form("SPINDLE", "Spindle", SYSTEM, Role.SERVICE, whole(SPINDLE.tab)),
        Form("DISPLAY", "Display", SYSTEM, Role.SERVICE, whole(DISPLAY.tab, by_axis=True)),
        Form("TOOL", "Tool", SYSTEM, Role.SERVICE, whole(TOOL.tab)),
        Form(
            "TOOLCOLORS", "Colours of tools", SYSTEM, Role.SERVICE,
            listed("", TOOL.colour), is_paged=True,
        ),
        Form(
            "TOOLTIPS", "Tips of tools", SYSTEM, Role.SETUP, listed("", TOOL.tip), is_paged=True
        ),
        Form(
            "GENERAL", "Machine", SYSTEM, Role.SERVICE,
            whole(GENERAL.tab, hidden=_SECRET | _OF_SETUP),
        ),
        Form(
            "R-GEOMETRY", "R offsets (geometric)", OFFSET, Role.SETUP,
            listed("", CELLS.d_radius[1:]), is_paged=True,
        ),
        Form(
            "R-WEAR", "R offsets (wear)", OFFSET, Role.OPERATE,
            listed("", CELLS.d_wear[1:]), is_paged=True,
        ),
        Form(
            "H-GEOMETRY", "H offsets (geometric)", OFFSET, Role.SETUP,
            listed("", CELLS.h_length[1:]), is_paged=True,
        ),
        Form(
            "H-WEAR", "H offsets (wear)", OFFSET, Role.OPERATE,
            listed("", CELLS.h_wear[1:]), is_paged=True,
        ),
        Form("FIXTURES", "Fixture offsets", OFFSET, Role.SETUP, _fixtures, is_paged=True),
        Form(
            "BACKLASH", "Backlash", OFFSET, Role.SERVICE, by_axis(("Backlash", OFFSETS.backlash))
        ),
        Form("REFERENCE", "Reference points", OFFSET, Role.SETUP, _references),
        Form("WORK", "Work coordinates 1 to 8", OFFSET, Role.SETUP, _work),
        Form("CMPRAD", "CMP RAD", SETUP, Role.OPERATE, listed("", [GENERAL.cmp_rad]), key="F1"),
        Form("FEEDRATE", "Feedrate", SETUP, Role.OPERATE, _feeds, key="F4"),
        Form(
            "MODALS", "Set modals", SETUP, Role.OPERATE, listed("", STARTS), key="F7",
            implied={GENERAL.start_set_chosen: 1.0},
        ),
        Form("MESSAGES", "User messages", PANEL, Role.SERVICE, _messages),
        Form("BUTTONS", "Virtual push buttons", PANEL, Role.SERVICE, _buttons),
        Form("IONAMES", "Names of inputs and outputs", PANEL, Role.SETUP, _line_names),
        Form("VIEWS", "Views", PANEL, Role.SETUP, listed("", DISPLAY.views)),
    )
}  # fmt: skip
