"""The sub-commands of `openacr` by name: where each is, and the families they form."""

from pathlib import Path
from typing import NamedTuple


class Entry(NamedTuple):
    """Location of a sub-command in the source."""

    module: str
    function: str
    takes_dashes: bool = False  # arguments may begin with a dash: "-soft limit x=-1"

    @property
    def summary(self) -> str:
        """The first line of its docstring, read from the source: a list imports no sub-command."""
        path = Path(__file__).parent.joinpath(*self.module.split(".")).with_suffix(".py")
        definition = path.read_text("utf-8").partition(f"\ndef {self.function}(")[2]
        return definition.partition('"""')[2].partition("\n")[0].removesuffix('"""')


class Family(NamedTuple):
    """Sub-commands under one name: `openacr mill run`; without a word the `default` is meant."""

    summary: str
    entries: "dict[str, Entry | Family]"
    default: str = ""


COMMANDS: dict[str, Entry | Family] = {
    "new": Entry("new", "new"),
    "examples": Family(
        "The example projects that come with the package.",
        {"list": Entry("examples", "list_examples"), "copy": Entry("examples", "copy_to")},
        default="list",
    ),
    "run": Entry("run.command", "run"),
    "serve": Entry("serve", "serve"),
    "bus": Family(
        "Drives and terminals on an EtherCAT bus, real or emulated.",
        {
            "emulate": Entry("bus_emulate", "emulate_bus"),
            "scan": Entry("bus", "scan_bus"),
            "state": Entry("bus", "show_states"),
            "watch": Entry("bus_watch", "watch_bus"),
            "sdo": Family(
                "Objects of a device.",
                {
                    "read": Entry("bus", "read_object"),
                    "write": Entry("bus", "write_object", takes_dashes=True),
                },
            ),
        },
    ),
    "panel": Entry("panel", "panel"),
    "bridge": Entry("bridge", "bridge"),
    "replay": Entry("run.replay", "replay"),
    "sweep": Entry("sweep.command", "sweep"),
    "debug": Entry("debug", "debug"),
    "term": Entry("live.term", "term"),
    "download": Entry("live.download", "download"),
    "upload": Entry("live.upload", "upload"),
    "monitor": Entry("live.monitor", "monitor"),
    "status": Entry("live.status", "status"),
    "probe": Entry("live.probe", "probe"),
    "record": Entry("record", "record"),
    "loop": Entry("live.loop", "loop"),
    "tune": Family(
        "Servo tuning: measure an axis, propose gains, set them.",
        {
            "measure": Entry("tune", "measure_axis"),
            "step": Entry("tune_step", "record_step"),
            "propose": Entry("tune", "propose_gains"),
            "apply": Entry("tune_apply", "apply_gains"),
            "undo": Entry("tune_apply", "undo_gains"),
        },
    ),
    "ip": Entry("explain.ip", "explain_address"),
    "backup": Entry("live.backup", "backup"),
    "restore": Entry("live.backup", "restore"),
    "compare": Entry("live.compare", "compare"),
    "conform": Entry("conform", "conform"),
    "configure": Entry("configure", "configure"),
    "list": Entry("check", "list_file"),
    "check": Entry("check", "check_file"),
    "dxf": Entry("drawing", "convert_drawing"),
    "lsp": Entry("lsp", "lsp"),
    "schema": Entry("explain.schema", "show_schema"),
    "packet": Entry("explain.packet", "explain_packet"),
    "param": Entry("explain.lookup", "show_parameter"),
    "flag": Entry("explain.lookup", "show_flag"),
    "mill": Family(
        "Part programs (RS-274): the CNC side.",
        {
            "check": Entry("mill.check", "check_program"),
            "dialect": Entry("mill.dialect", "show_dialect"),
            "time": Entry("mill.check", "time_program"),
            "list": Entry("mill.listing", "list_program"),
            "plot": Entry("mill.plot", "plot_program"),
            "run": Entry("mill.run", "run_program"),
            "batch": Entry("mill.run", "run_batch"),
            "drip": Entry("mill.drip", "drip_program"),
            "receive": Entry("mill.drip", "receive_program"),
            "teach": Entry("mill.teach", "teach_system"),
            "jog": Entry("mill.hand", "jog_axes"),
            "mdi": Entry("mill.hand", "run_blocks"),
            "zero": Family(
                "The floating zero of a card: SET ZERO, CLR ZERO, GOTO ZERO.",
                {
                    "set": Entry("mill.zero", "set_floating_zero"),
                    "clear": Entry("mill.zero", "clear_floating_zero"),
                    "goto": Entry("mill.zero", "go_to_zero"),
                },
            ),
            "home": Entry("mill.hand", "home_axes"),
            "stop": Entry("mill.stop", "stop_machine"),
            "acknowledge": Entry("mill.hand", "acknowledge_alarms"),
            "import": Entry("mill.drawing", "import_drawing"),
            "part": Entry("mill.part", "make_part"),
            "param": Entry("mill.param", "operate_parameters"),
            "message": Family(
                "Texts shown while an input, output or flag has a given state.",
                {
                    "list": Entry("mill.message", "list_messages"),
                    "set": Entry("mill.message", "set_message"),
                    "remove": Entry("mill.message", "remove_message"),
                },
            ),
            "ballscrew": Family(
                "Tables that compensate errors of ballscrews.",
                {
                    "import": Entry("mill.ballscrew", "import_table"),
                    "export": Entry("mill.ballscrew", "export_table"),
                    "from-measurements": Entry("mill.ballscrew", "make_table"),
                },
            ),
        },
    ),
    "verify": Entry("verify.command", "verify"),
    "sysvar": Family(
        "System parameters, offsets and variables of the CNC side (the SYSVAR store).",
        {
            "get": Entry("sysvar.read", "get", takes_dashes=True),
            "set": Entry("sysvar.change", "set_values", takes_dashes=True),
            "list": Entry("sysvar.read", "list_values"),
            "export": Entry("sysvar.change", "export_values"),
            "import": Entry("sysvar.change", "import_values"),
            "password": Entry("sysvar.change", "change_password"),
        },
    ),
}
