"""Numbers of a move in the arrays of many moves (`canonical/batches.py`)."""

AXES = 8
POINT = 8  # numbers of an end
ROW = 8  # numbers of a row:
KIND = 0
LINE_NUMBER = 1
PACE = 2  # index of its pace
PLANE = 3  # 17 to 19; of a note its number
START = 4  # where its line begins and ends in its text
STOP = 5
TEXT = 6  # 0 the program, 1 the cycles
FLAGS = 7

RAPID = 0  # kinds
LINE = 1
ARC = 2
NOTE = 3  # a handler is called here; its end has the words of the code

INSERTED = 1  # flags
COMPENSATED = 2

CURVE = 5  # numbers of an arc:
CENTRE_FIRST = 0  # its centre on the first axis of the plane
CENTRE_SECOND = 1
SWEEP_RAD = 2  # + counter-clockwise
START_RADIUS = 3
END_RADIUS = 4
