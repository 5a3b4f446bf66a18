"""Hidden rows of the devices #0 to #3 of the programs: what waits to be read.

Instance 4 * program + device. Programs that wait for input wait for these rows.
"""

from openacr.map.hidden.block import HiddenBlock

DEVICES = HiddenBlock(
    prefix="DQ",
    family="devices",
    count=64,
    ints=(
        "characters",  # received and not read
        "lines",  # complete lines among them
        "prompted",  # INPUT has sent its prompt and waits for the line
    ),
)
