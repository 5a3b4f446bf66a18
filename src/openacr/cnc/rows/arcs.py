"""Numbers of one arc in its plane (`geometry/arc_cy.py`)."""

X0 = 0  # start
Y0 = 1
X1 = 2  # end
Y1 = 3
CX = 4  # centre
CY = 5
SWEEP_RAD = 6  # + counter-clockwise
R0 = 7  # radius at the start
R1 = 8  # and at the end
SIZE = 9
