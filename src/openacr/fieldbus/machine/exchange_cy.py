"""The cyclic frame of a bus in the real-time loop: process data to rows of the card and back.

What has to be on time is here: targets, positions, contacts, and the reactions to what goes wrong.
Which control word a drive gets is decided by Python (`realtime_bus.py`), which writes the outputs
of all devices into one of two images (BASE); the loop lays its targets and outputs over it.

At the beginning of a period the outputs of the tick before go out, and what comes back takes effect
in the tick that follows. B are whole numbers, N doubles, X the frame that goes out and the two
images, Y the frame that came back. Nothing here allocates or fails.
"""

from openacr.cmath import fabs, rint
from openacr.csystem import frame_exchange, now_ns
from openacr.map.rows import axes, bus_motors, encoders, input_words, motors
from openacr.map.words import af4
from openacr.plant.physics.drive_cy import converter_volts
from openacr.views import F32, F64, I32, U8

__all__ = ["bus_exchange", "bus_give", "bus_take", "clock_steer", "counters_begin"]

# Rows of B; the writer in brackets.
ACTIVE = 0  # 1: frames are exchanged [Python]
SOCKET = 1
FRAME_SIZE = 2
IMAGE_AT = 3  # of the image, in the frame
OUTPUTS_SIZE = 4  # of the image; inputs follow
COUNTER_AT = 5  # of the working counter, in the frame
COUNTER = 6  # if all devices take part
STATUS_AT = 7  # of the joint state of all devices, in the frame
FORBIDDEN = 8  # bits of a joint state that is not operation
OPERATING = 9  # bit that it has
DATAGRAMS = 10
DEVICES = 11  # that are asked for their states, one in each frame; 0: none is
ASKED = 12  # which was asked last [loop]
ASK_AT = 13  # of the datagram that asks, in the frame
CYCLE_TK = 14
WAIT_TK = 15  # [loop]
LOST_FRAMES = 16  # in a row that may be lost
BAD = 17  # in a row [loop]
ALARM = 18  # what has stopped all drives [loop]
DRIVES = 19
INPUTS = 20
OUTPUTS = 21
BASE = 22  # which image is valid [Python]
FRESH = 23  # 1: a frame came back whole and is to be taken [loop]
GOOD = 24  # counts frames that came back whole [loop]
SENT = 25  # counts frames, the index of the datagrams [loop]
CLOCK_AT = 26  # of the time of the first device that has a clock, in the frame; 0 without
INDEX_AT = 27  # of each datagram (4 rows), in the frame
STATION = 31  # of the first device
FIRST_DRIVE = 32
DRIVE_ROWS = 16
FIRST_CONTACT = 288  # inputs, then outputs
CONTACT_ROWS = 5
MOST_CONTACTS = 1024
FIRST_DEVICE = 5408
DEVICE_ROWS = 2
MOST_DEVICES = 1024
B_ROWS = 7456

# Rows of a drive.
OWNER = 0  # axis, -1 without one [Python]
READY = 1  # it is to follow the setpoint [Python]
FOLLOWS = 2  # it has followed it since it is ready [loop]
CONTROL_AT = 3  # places in the image
TARGET_AT = 4
TARGET_SIZE = 5
STATE_AT = 6
ACTUAL_AT = 7
IS_POSITION = 8  # mode csp
MOTOR = 9
IS_KNOWN = 10  # it has reported a position [loop; Python clears it]
FAILED = 11  # what has stopped it [loop; Python clears it]
JUMP_CNT = 12  # by which its position jumped [loop]

# Rows of a contact: byte and bit in the image, word and mask of the card, slot of input_words.
BYTE = 0
BIT = 1
WORD = 2
MASK = 3
SLOT = 4

# Rows of a device, as the loop has heard it last.
AL_STATUS = 0  # 0 while it does not answer
AL_CODE = 1

# Rows of N.
RETURN_NS = 0  # a frame may take
LATE_NS = 1  # between two exchanges
LATEST_NS = 2  # exchange
CYCLE_NS = 3
STEER_NS = 4  # by which the next period is longer, to follow the clock of the devices
PHASE_NS = 5  # how far the frame is from the middle between two SYNC0
SENT_FRAMES = 6  # counters, until they begin anew
MISSING_FRAMES = 7
WRONG_FRAMES = 8  # that came back with a wrong working counter
LATE_FRAMES = 9  # that went out late after the last one that came back
WORST_RETURN_NS = 10
FIRST_NUMBERS = 16
DRIVE_NUMBERS = 8
N_ROWS = 144

# Numbers of a drive.
COUNTS = 0  # of the drive, beyond 32 bits
ZERO = 1  # counts that are the card's count at power-up
SCALE = 2  # counts for a raw count of the card
PER_VOLT = 3
FASTEST_CPS = 4

POSITION_AT = 2  # of a datagram: the address of its device
HEADER = 10
ASK_SIZE = 6  # bytes that a device answers, from its AL status on
CODE_AT = 4  # in them
LATE_CYCLES = 1.5  # of a late frame

# Images in X.
FRAME_ROOM = 1536
BASES = 1536
X_SIZE = 4608

# What has stopped all drives, and what has stopped one.
ALARM_LOST = 1
ALARM_COUNTER = 2
ALARM_LATE = 3
ALARM_LEFT = 4
FAILED_JUMP = 1
FAILED_STATE = 2

STEER_GAIN = 0.0625
STEER_PART = 0.001  # of a cycle, at most
QUICK_STOP = 2
DISABLE_VOLTAGE = 0
STATE_MASK = 111
IN_OPERATION = 39
MIDDLE = 0.5
JITTER_CNT = 16.0
RAW_COUNTS = 4.0


def word_of(Y: U8, at: int) -> int:
    """Sixteen bits."""
    return Y[at] | (Y[at + 1] << 8)


def long_of_image(Y: U8, at: int) -> int:
    """Thirty-two bits with a sign."""
    found: int = word_of(Y, at) | (word_of(Y, at + 2) << 16)
    return found - 4294967296 if found >= 2147483648 else found


def put(X: U8, at: int, size: int, value: int) -> None:
    """Write the low bytes of a number."""
    rest: int = value
    for k in range(size):
        X[at + k] = rest & 255
        rest = rest >> 8


def clock_steer(N: F64, reference: int, cycle: int) -> None:
    """Let frames pass the first device in the middle between two SYNC0.

    SYNC0 comes at whole cycles of its clock; `reference` is its time at the frame [ns].
    """
    turns: int = int(float(reference) / float(cycle))  # one too many or too few at most
    phase: int = reference - turns * cycle
    if phase < 0:
        phase += cycle
    elif phase >= cycle:
        phase -= cycle
    error: float = float(phase) - 0.5 * float(cycle)
    most: float = STEER_PART * float(cycle)
    N[PHASE_NS] = error
    N[STEER_NS] = max(-most, min(most, -STEER_GAIN * error))


def counters_begin(N: F64) -> None:
    """Let the counters begin at 0."""
    for k in range(SENT_FRAMES, WORST_RETURN_NS + 1):
        N[k] = 0.0


def device_ask(B: I32, X: U8) -> None:
    """Address the next device with the datagram that asks for a state."""
    B[ASKED] = B[ASKED] + 1 if B[ASKED] + 1 < B[DEVICES] else 0
    put(X, B[ASK_AT] + POSITION_AT, 2, B[STATION] + B[ASKED])


def device_note(B: I32, Y: U8, is_back: bool) -> None:
    """What the device that was asked has answered."""
    r: int = FIRST_DEVICE + DEVICE_ROWS * B[ASKED]
    answer: int = B[ASK_AT] + HEADER
    is_heard: bool = is_back and word_of(Y, answer + ASK_SIZE) == 1
    B[r + AL_CODE] = word_of(Y, answer + CODE_AT) if is_heard else 0
    B[r + AL_STATUS] = word_of(Y, answer) if is_heard else 0


def bus_exchange(B: I32, N: F64, X: U8, Y: U8, now: int) -> None:
    """Send the outputs and wait for what comes back, at most RETURN_NS; no state is touched."""
    B[FRESH] = 0
    N[STEER_NS] = 0.0
    B[WAIT_TK] = B[WAIT_TK] - 1
    if B[ACTIVE] == 0 or B[WAIT_TK] > 0:
        return
    B[WAIT_TK] = B[CYCLE_TK]
    B[SENT] = B[SENT] + 1 if B[SENT] < 255 else 1
    for k in range(B[DATAGRAMS]):
        X[B[INDEX_AT + k]] = B[SENT]
    if B[DEVICES]:
        device_ask(B, X)
    N[SENT_FRAMES] += 1.0
    passed: float = float(now) - N[LATEST_NS] if N[LATEST_NS] > 0.0 else 0.0
    if passed > LATE_CYCLES * N[CYCLE_NS]:
        N[LATE_FRAMES] += 1.0
    if passed > N[LATE_NS]:
        bus_alarm(B, ALARM_LATE)
    size: int = frame_exchange(
        B[SOCKET], X, B[FRAME_SIZE], Y, FRAME_ROOM, B[INDEX_AT], now + int(N[RETURN_NS])
    )
    N[WORST_RETURN_NS] = max(N[WORST_RETURN_NS], float(now_ns() - now))
    is_back: bool = size >= B[FRAME_SIZE]
    for k in range(B[DATAGRAMS]):
        at: int = B[INDEX_AT + k]
        is_back = is_back and Y[at] == X[at] and Y[at - 1] == X[at - 1]
    if B[DEVICES]:
        device_note(B, Y, is_back)
    is_whole: bool = is_back and word_of(Y, B[COUNTER_AT]) == B[COUNTER]
    if is_whole:
        B[BAD] = 0
        B[FRESH] = 1
        B[GOOD] = (B[GOOD] + 1) & 1073741823
        if B[CLOCK_AT]:
            low: int = long_of_image(Y, B[CLOCK_AT]) & 4294967295
            high: int = long_of_image(Y, B[CLOCK_AT] + 4)
            clock_steer(N, (high << 32) | low, int(N[CYCLE_NS]))
        return
    if is_back:
        N[WRONG_FRAMES] += 1.0
    else:
        N[MISSING_FRAMES] += 1.0
    B[BAD] = B[BAD] + 1
    if B[BAD] > B[LOST_FRAMES]:
        bus_alarm(B, ALARM_COUNTER if is_back else ALARM_LOST)


def bus_alarm(B: I32, what: int) -> None:
    """All drives are stopped, by the first reason."""
    if B[ALARM] == 0:
        B[ALARM] = what


def axis_stop(I: I32, n: int) -> None:
    """Motion of an axis is killed and Drive Fault is set."""
    if n >= 0:
        word: int = af4.word[n]
        I[word] = I[word] | af4.DRIVE_FAULT | af4.KILL_ALL_MOTION_REQUEST


def bus_take(F: F64, I: I32, B: I32, N: F64, Y: U8, now: int) -> None:
    """Bring what came back into the rows of the tick; an alarm stops every axis."""
    if B[FRESH]:
        status: int = word_of(Y, B[STATUS_AT])
        if status & B[FORBIDDEN] or not status & B[OPERATING]:
            bus_alarm(B, ALARM_LEFT)
        for d in range(B[DRIVES]):
            drive_take(F, I, B, N, Y, d, now)
        N[LATEST_NS] = float(now)
        for k in range(B[INPUTS]):
            contact_take(I, B, Y, FIRST_CONTACT + CONTACT_ROWS * k)
    if B[ALARM]:
        for d in range(B[DRIVES]):
            r: int = FIRST_DRIVE + DRIVE_ROWS * d
            if B[r + READY]:
                axis_stop(I, B[r + OWNER])


def drive_take(F: F64, I: I32, B: I32, N: F64, Y: U8, d: int, now: int) -> None:
    """The position that a drive reports; a jump, or the end of operation, stops its axis."""
    r: int = FIRST_DRIVE + DRIVE_ROWS * d
    f: int = FIRST_NUMBERS + DRIVE_NUMBERS * d
    image: int = B[IMAGE_AT]
    actual: int = long_of_image(Y, image + B[r + ACTUAL_AT])
    if B[r + IS_KNOWN] == 0:
        B[r + IS_KNOWN] = 1
        if N[f + ZERO] != N[f + ZERO]:  # the first position of all
            N[f + ZERO] = float(actual)
        N[f + COUNTS] = float(actual)
    counts: int = int(N[f + COUNTS])
    moved: int = (actual - counts) & 4294967295
    moved = moved - 4294967296 if moved >= 2147483648 else moved
    # A drive travels for a cycle between two frames, however soon one follows a late one.
    passed_s: float = 1e-9 * max(float(now) - N[LATEST_NS], N[CYCLE_NS])
    N[f + COUNTS] = float(counts + moved)
    F[bus_motors.reported_cnt[B[r + MOTOR]]] = (N[f + COUNTS] - N[f + ZERO]) / N[f + SCALE] + MIDDLE
    if B[r + READY] == 0 or B[r + FAILED]:
        return
    if fabs(float(moved)) > N[f + FASTEST_CPS] * passed_s + JITTER_CNT:
        B[r + JUMP_CNT] = moved
        B[r + FAILED] = FAILED_JUMP
    elif (word_of(Y, image + B[r + STATE_AT]) & STATE_MASK) != IN_OPERATION:
        B[r + FAILED] = FAILED_STATE
    if B[r + FAILED]:
        axis_stop(I, B[r + OWNER])


def contact_take(I: I32, B: I32, Y: U8, r: int) -> None:
    """An input that the bus drives; a forced one keeps its level."""
    slot: int = B[r + SLOT]
    mask: int = B[r + MASK]
    word: int = B[r + WORD]
    if (Y[B[IMAGE_AT] + B[r + BYTE]] >> B[r + BIT]) & 1:
        I[input_words.level[slot]] = I[input_words.level[slot]] | mask
        if not I[input_words.stuck[slot]] & mask:
            I[word] = I[word] | mask
    else:
        I[input_words.level[slot]] = I[input_words.level[slot]] & ~mask
        if not I[input_words.stuck[slot]] & mask:
            I[word] = I[word] & ~mask


def bus_give(F: F64, I: I32, S: F32, B: I32, N: F64, X: U8) -> None:
    """The outputs after a tick: what Python asks of the devices, targets and contacts over it."""
    if B[ACTIVE] == 0:
        return
    image: int = B[IMAGE_AT]
    base: int = BASES + FRAME_ROOM * B[BASE]
    for k in range(B[OUTPUTS_SIZE]):
        X[image + k] = X[base + k]
    for d in range(B[DRIVES]):
        drive_give(F, I, S, B, N, X, d)
    for k in range(B[INPUTS], B[INPUTS] + B[OUTPUTS]):
        r: int = FIRST_CONTACT + CONTACT_ROWS * k
        at: int = image + B[r + BYTE]
        bit: int = 1
        bit = bit << B[r + BIT]
        if I[B[r + WORD]] & B[r + MASK]:
            X[at] = X[at] | bit
        else:
            X[at] = X[at] & ~bit & 255


def drive_give(F: F64, I: I32, S: F32, B: I32, N: F64, X: U8, d: int) -> None:
    """The target of a drive, and the control word that cannot wait for Python."""
    r: int = FIRST_DRIVE + DRIVE_ROWS * d
    f: int = FIRST_NUMBERS + DRIVE_NUMBERS * d
    image: int = B[IMAGE_AT]
    n: int = B[r + OWNER]
    is_on: bool = B[r + READY] != 0 and n >= 0 and (I[af4.word[n]] & af4.DRIVE_ENABLED) != 0
    if B[r + READY] == 0:
        B[r + FOLLOWS] = 0
    if B[ALARM] or B[r + FAILED]:
        put(X, image + B[r + CONTROL_AT], 2, QUICK_STOP)
    elif is_on:
        B[r + FOLLOWS] = 1
    elif B[r + FOLLOWS]:  # the card has switched it off
        put(X, image + B[r + CONTROL_AT], 2, DISABLE_VOLTAGE)
    put(
        X, image + B[r + TARGET_AT], B[r + TARGET_SIZE], drive_target(F, I, S, B, N, r, f, n, is_on)
    )


def drive_target(
    F: F64, I: I32, S: F32, B: I32, N: F64, r: int, f: int, n: int, is_on: bool
) -> int:
    """Where the setpoint means the drive to be, or what the converter asks of it."""
    motor: int = B[r + MOTOR]
    value: float = 0.0
    if B[r + IS_POSITION]:
        value = N[f + COUNTS]
        mult: int = I[encoders.mult[motor]]
        if is_on and mult:
            # With the fraction that the encoder carries the target depends on the setpoint alone.
            actual: float = float(I[axes.actual_position[n]]) + F[encoders.partial_cnt[motor]]
            missing: float = F[axes.ssp_cnt[n]] - actual
            place: float = F[motors.raw_count[motor]] + missing * RAW_COUNTS / float(mult)
            value = N[f + ZERO] + rint(place * N[f + SCALE])
        return int(value)
    if not is_on:
        return 0
    value = converter_volts(S, I[motors.dac[motor]], F[motors.dac_step[motor]]) * N[f + PER_VOLT]
    most: float = 32767.0 if B[r + TARGET_SIZE] == 2 else 2147483647.0
    value = max(-most, min(most, rint(value)))
    return int(value)
