"""The ends of the error band, whose excess kills an axis."""

KAMR_X, KAMR_Y, KILL_MOVES, STOP_MOVES = 8467, 8499, 522, 523
ACTIVE, IN_MOTION = 792, 516
CURRENT, ACTUAL, PSP, JOG = 12288, 12290, 12294, 12297
IDEAL_MOTOR = 3
KILLED = "Associated Slave Kill Motion Request Active"

KAMR_Y = 8499
