"""Back up everything a terminal can read of a card, as controller files that restore it.

The settings come from the command table of the language: every command that is saved and
reports its value when typed without one. If a card does not know one of them the backup
still succeeds; a remark in the file names what is missing.

Not included, because a terminal cannot read it or must not write it back: the network
address, passwords, positions and captures, running programs and their local variables,
strings, settings of masters that no program has, and what the drives and the machine store.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.language import registry
from openacr.basic.language.registry import BY_OBJECT, INDEX, Command
from openacr.basic.memory.storage import Storage
from openacr.client import values
from openacr.client.effects import Op
from openacr.client.errors import RefusedError
from openacr.client.names import flag_number, parameter_number
from openacr.client.requests import SYS, Level
from openacr.client.talk import Talk
from openacr.client.transfer import Progress, upload
from openacr.errors import UserError, unreadable, unwritable
from openacr.lang.attachments import attachments

Files: TypeAlias = list[tuple[Path, Level, str]]

AXES, PROGRAMS, PLCS = 16, 16, 8
SETUP_FILE = "setup.8k"
NOT_UNDERSTOOD, NOT_READABLE = "REM not understood: ", "REM not readable: "
_HEAD = ("SYS", "HALT ALL", "NEW ALL", "CLEAR", "DETACH ALL")
# Covered by another row, or not to be written back.
_LEFT_OUT = frozenset(("F", "MULT", "IP", "CONFIG", "FOV", "ROV"))
_SYSTEM_ROWS = ("PERIOD", "ADC MODE", "ADC MAX")
_OF_CHANNEL = ("ADC POS", "ADC NEG")  # their object is the first number after the words
_OF_MASTER = "VECDEF"  # set per axis, but only while the axis has a master
# Kept by ESAVE beside the commands. Of the network only what a host may write.
_AXIS_PARAMETERS = ("rpm factor", "lock feedback gain", "cam velocity smooth", "dgain smooth")
_MASTER_PARAMETER = "int response period"
_IN_MOVE_TIME = "master in tmov"
_LISTS_NUMBERS = "BIT5651"
_CANOPEN_COUNT = "number of slave nodes"
_CANOPEN = ("master node id", "bit rate", "alternate digital i/o mapping", "cyclic period")
_CANOPEN_NODES, _CANOPEN_CHANNELS = 4, 32
_FLAGS = (
    "drive fault level invert",
    "step direction output",
    "drive i/o enable",
    "exc response enable",
    "disable drive on exc only",
    "disable drive on kill",
    "positive limit level invert",
    "negative limit level invert",
    "home level invert",
    "positive hardware limit enable",
    "negative hardware limit enable",
    "positive software limit enable",
    "negative software limit enable",
    "home backup enable",
    "home negative edge select",
    "home negative final direction",
    "jog limit check",
)
_NUMBER = r"-?[\d.]+(?:[Ee][-+]?\d+)?"
_VALUE = re.compile(rf"{_NUMBER}(?:,{_NUMBER})?|ON|OFF")
_SOURCE = re.compile(r"NONE|CLK|[A-Z]+\d+")  # as the card reports and takes it
_OWN_SETPOINT = "PSP"  # of a ballscrew without a source, which no line can choose
_ATTACHED_AXIS = re.compile(r"ATTACH AXIS(\d+) ")
_MAINTENANCE = re.compile(r"(\w+) (ON|OFF)")
_CHANNEL_WORDS = frozenset(("ENC", "DAC", "ADC"))  # of commutators: CMT0 DAC0 DAC1
_VARIABLES = re.compile(r"DIM P\((\d+)\)")


@dataclass(slots=True)
class _Reader:
    """Collects the lines that restore what the card reports."""

    talk: Talk
    progress: Progress | None
    total: int = 1
    done: int = 0
    lines: list[str] = field(default_factory=list)

    def ask(self, query: str, *, at: Level = SYS) -> Op[tuple[str, ...]]:
        """Ask the card; an unknown query returns nothing and leaves a remark."""
        self.done += 1
        if self.progress is not None:
            self.progress(min(self.done, self.total), self.total)
        try:
            return (yield from self.talk.query(query, at=at))
        except RefusedError as refused:
            self.lines.append(f"{NOT_READABLE}{query}: {refused.text}")
            return ()

    def setting(self, row: Command, command: str = "", *, at: Level = SYS) -> Op[None]:
        """Add a command with the value it reports; `command` is the form of the query.

        An extension is omitted unless it is set: real cards refuse it.
        """
        command = command or row.name
        for value in (yield from self.ask(command, at=at)):
            if row.words[-1] == "SRC" and _SOURCE.fullmatch(value):
                self.lines.append(f"{command} {value}")
            elif value == _OWN_SETPOINT:
                continue
            elif not _VALUE.fullmatch(value):
                self.lines.append(f"{NOT_UNDERSTOOD}{command}: {value}")
            elif row.words[-1] in _CHANNEL_WORDS:
                first, second = value.split(",")
                self.lines.append(f"{command}{first} {row.words[-1]}{second}")
            elif not (row.is_extension and float(value) == float(row.default or 0)):
                self.lines.append(f"{command} ({value})" if "," in value else f"{command} {value}")

    def parameter(self, name: str) -> Op[float]:
        """Add the assignment of a parameter that no command sets; its value, 0 without one."""
        number, found = parameter_number(name), 0.0
        for value in (yield from self.ask(f"?P{number}")):
            if re.fullmatch(_NUMBER, value):
                self.lines.append(f"P{number}={value}")
                found = float(value)
            else:
                self.lines.append(f"{NOT_UNDERSTOOD}P{number}: {value}")
        return found

    def count(self, query: str) -> Op[int]:
        """How many objects answer a query with `#` in the place of their number."""
        number = 0
        while True:
            try:
                yield from self.talk.query(query.replace(INDEX, str(number)), at=SYS)
            except RefusedError as refused:
                if number == 0:
                    self.lines.append(f"{NOT_READABLE}{refused.line}: {refused.text}")
                return number
            number += 1

    def commands(self, query: str, word: str, *, at: Level = SYS) -> Op[list[str]]:
        """Return the reported lines that are commands beginning with a word."""
        found: list[str] = []
        for line in (yield from self.ask(query, at=at)):
            if line.startswith(f"{word} "):
                found.append(line)
            else:
                self.lines.append(f"{NOT_UNDERSTOOD}{query}: {line}")
        return found


def backup(talk: Talk, progress: Progress | None = None) -> Op[dict[str, str]]:
    """Return the files by name: setup.8k, and prog0.8k, plc0.8k ... for stored programs."""
    home = talk.level
    reader = _Reader(talk, progress)
    version = yield from reader.ask("VER")
    reader.lines += [f"REM Backup of {line}" for line in version[:1]] + list(_HEAD)
    yield from _read_system(reader)
    files = {SETUP_FILE: "".join(f"{line}\n" for line in reader.lines)}
    for level in levels():
        try:
            text = yield from upload(talk, level)
        except RefusedError as refused:
            files[SETUP_FILE] += f"{NOT_READABLE}{level}: {refused.text}\n"
        else:
            files |= {_file_name(level): text} if text else {}
    yield from talk.go(home)
    return files


def surroundings(talk: Talk, level: Level) -> Op[str]:
    """The memory, aliases and axes that a program or PLC finds on the card, as set-up code."""
    home = talk.level
    reader = _Reader(talk, None)
    sizes, aliases, attached = yield from _memory_and_names(reader)
    reader.lines += [str(SYS), *sizes, *aliases, *attached]
    if level.word == "PROG":
        yield from _read_program(reader, level, [])
    yield from talk.go(home)
    return "".join(f"{line}\n" for line in reader.lines)


def _memory_and_names(reader: _Reader) -> Op[tuple[list[str], list[str], list[str]]]:
    """What SYS reports of memory, aliases and axes."""
    sizes = yield from reader.commands("DIM", "DIM")
    aliases = yield from reader.commands("DEF", "#DEFINE")
    attached = yield from reader.commands("ATTACH", "ATTACH")
    return sizes, aliases, attached


def _read_system(reader: _Reader) -> Op[None]:
    sizes, aliases, attached = yield from _memory_and_names(reader)
    sizes = [line for line in sizes if line not in Storage.factory_lines()]  # CLEAR sets these
    axes = [int(found[1]) for found in map(_ATTACHED_AXIS.match, attached) if found]
    if not axes:
        axes = yield from _axes_that_answer(reader)
    modules = yield from reader.commands("CONFIG", "CONFIG")
    reader.lines += [*modules, *sizes, *aliases]
    objects = yield from _objects(reader)
    of_axis = list(_axis_rows())
    each = len(of_axis) + len(_AXIS_PARAMETERS) + 1
    reader.total = reader.done + len(objects) + each * len(axes) + 3 * PROGRAMS
    for words in _SYSTEM_ROWS:
        yield from reader.setting(registry.find(words))
    yield from _read_flags(reader, [_LISTS_NUMBERS])
    reader.lines += attached
    for row, query in objects:
        yield from reader.setting(row, query)
    for axis in axes:
        yield from _read_axis(reader, axis, of_axis)
    yield from _read_network(reader)
    yield from _read_variables(reader, sizes)
    masters = list(_master_rows())
    for number in range(PROGRAMS):
        yield from _read_program(reader, Level.program(number), masters)


def _objects(reader: _Reader) -> Op[list[tuple[Command, str]]]:
    """Every setting of every encoder, output, input ... that the card has, with its query."""
    counts: dict[str, int] = {}
    found = []
    for row in _object_rows():
        is_last = row.name in _OF_CHANNEL
        query = f"{row.name} {INDEX}" if is_last else row.name.replace(" #", "#")
        kind = row.name if is_last else row.words[0]
        if kind not in counts:
            counts[kind] = yield from reader.count(query)
        found += [(row, query.replace(INDEX, str(each))) for each in range(counts[kind])]
    return found


def _axes_that_answer(reader: _Reader) -> Op[list[int]]:
    """The axes of a card that does not report how they are attached."""
    for axis in range(AXES):
        try:
            yield from reader.talk.query(f"AXIS{axis} PPU", at=SYS)
        except RefusedError:
            return list(range(axis))
    return list(range(AXES))


def _read_axis(reader: _Reader, axis: int, commands: list[Command]) -> Op[None]:
    for row in commands:
        yield from reader.setting(row, f"AXIS{axis} {row.name}")
    for name in _AXIS_PARAMETERS:
        yield from reader.parameter(f"axis{axis}.{name}")
    yield from _read_flags(reader, [f"axis{axis}.{name}" for name in _FLAGS])
    for state in (yield from reader.ask(f"AXIS{axis}")):
        if state in ("ON", "OFF"):
            reader.lines.append(f"AXIS{axis} {state}")


def _read_flags(reader: _Reader, names: Iterable[str]) -> Op[None]:
    """Flags that configure an axis, or how the card lists programs."""
    numbers = [flag_number(name) for name in names]
    for number, is_set in zip(
        numbers, (yield from values.read_bits(reader.talk, numbers)), strict=True
    ):
        reader.lines.append(f"{'SET' if is_set else 'CLR'} BIT{number}")


def _read_network(reader: _Reader) -> Op[None]:
    """The settings of CANopen; channels have some only where there are nodes."""
    nodes = yield from reader.parameter(f"can.{_CANOPEN_COUNT}")
    for name in _CANOPEN:
        yield from reader.parameter(f"can.{name}")
    for node in range(_CANOPEN_NODES):
        yield from reader.parameter(f"cannode{node}.node id")
    for channel in range(_CANOPEN_CHANNELS * int(nodes)):
        for kind in ("dac", "adc"):
            yield from reader.parameter(f"can{kind}{channel}.{kind} gain")
            yield from reader.parameter(f"can{kind}{channel}.{kind} offset")


def _read_variables(reader: _Reader, sizes: Iterable[str]) -> Op[None]:
    """The user's P variables that are not zero."""
    counts = [int(found[1]) for found in map(_VARIABLES.fullmatch, sizes) if found]
    for number in range(max(counts, default=0)):
        value = yield from values.ask(reader.talk, f"P{number}", at=SYS)
        if value:
            reader.lines.append(f"P{number}={values.number_text(value)}")


def _read_program(reader: _Reader, level: Level, commands: list[Command]) -> Op[None]:
    attached = yield from reader.commands("ATTACH", "ATTACH", at=level)
    sizes = yield from reader.commands("DIM", "DIM", at=level)
    if attached or sizes:
        reader.lines += [str(level), *attached, *sizes]
    for row in commands if attached else ():
        yield from reader.setting(row, at=level)
    if commands:
        yield from _read_switches(reader, level, attached)
    for slave in attachments(attached)[1]:
        row = registry.find(_OF_MASTER)
        yield from reader.setting(row, f"AXIS{slave.axis} {_OF_MASTER}", at=level)


def _read_switches(reader: _Reader, level: Level, attached: Iterable[str]) -> Op[None]:
    """What ON and OFF have set: timed moves of a master, position maintenance of its axes."""
    master, slaves = attachments(attached)
    if master is not None:
        yield from reader.parameter(f"master{master}.{_MASTER_PARAMETER}")
        yield from _read_flags(reader, [f"master{master}.{_IN_MOVE_TIME}"])
    if slaves:
        for line in (yield from reader.ask("PM", at=level)):
            found = _MAINTENANCE.fullmatch(line)
            reader.lines.append(
                f"PM {found[2]} {found[1]}" if found else f"{NOT_UNDERSTOOD}PM: {line}"
            )


def levels() -> Iterator[Level]:
    """Every program and PLC there can be."""
    yield from map(Level.program, range(PROGRAMS))
    yield from map(Level.plc, range(PLCS))


def _file_name(level: Level) -> str:
    return f"{level.word.lower()}{level.number}.8k"


# --- which commands report a setting ------------------------------------------------------


def _saved() -> Iterator[Command]:
    """Every command whose value is saved and reported; a switch would act if it were asked."""
    for row in registry.commands():
        is_reported = row.saved and row.grammar and row.words[0] != "ATTACH"
        if is_reported and not row.is_switch and row.name not in _LEFT_OUT:
            yield row


def _axis_rows() -> Iterator[Command]:
    """Commands of one axis; PPU first, since the others count in units."""
    own = (row for row in _saved() if row.grammar[0].names_axes and row.name != _OF_MASTER)
    yield from sorted(own, key=lambda row: row.name != "PPU")


def _object_rows() -> Iterator[Command]:
    """Commands of encoders, outputs and inputs."""
    yield from (row for row in _saved() if INDEX in row.words or row.name in _OF_CHANNEL)


def _master_rows() -> Iterator[Command]:
    """Commands of a master, whose time comes before what it switches on."""
    for row in _saved():
        if row.levels == BY_OBJECT and not row.grammar[0].names_axes:
            yield row


# --- folders ------------------------------------------------------------------------------


def write_folder(files: dict[str, str], folder: Path) -> None:
    """Write a backup to a new or empty folder; UserError if it holds controller files."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if present := sorted(path.name for path in folder.glob("*.8k")):
            raise UserError(f"{folder}: {present[0]} already exists; choose an empty folder")
        for name, text in files.items():
            (folder / name).write_text(text, encoding="latin-1", newline="\n")
    except OSError as failure:
        raise unwritable(folder, failure) from None


def not_understood(folder: Path) -> list[str]:
    """What a backup could not keep: answers of the card that no line would set again."""
    lines = (folder / SETUP_FILE).read_text(encoding="latin-1").splitlines()
    return [line.removeprefix(NOT_UNDERSTOOD) for line in lines if line.startswith(NOT_UNDERSTOOD)]


def read_folder(folder: Path) -> Files:
    """Read the files of a backup, in the order they are sent: set-up, programs, PLCs."""
    present = [(folder / name, level) for name, level in _file_names() if (folder / name).is_file()]
    if not present or present[0][0].name != SETUP_FILE:
        raise UserError(f"{folder} is not a backup: it has no {SETUP_FILE}")
    try:
        return [(path, level, path.read_text(encoding="latin-1")) for path, level in present]
    except OSError as failure:
        raise unreadable(folder, failure) from None


def files_of(texts: dict[str, str]) -> Files:
    """The files returned by `backup`, in the order they are sent."""
    return [(Path(name), level, texts[name]) for name, level in _file_names() if name in texts]


def _file_names() -> Iterator[tuple[str, Level]]:
    """Every file a backup may have, in the order they are sent."""
    yield SETUP_FILE, SYS
    yield from ((_file_name(level), level) for level in levels())
