; Written for the AcroMill language: a ring of holes by a loop
G20 G90 G17
P200=0
F20
G0 Z.5
N100 G0 X(2*COS(P200)) Y(2*SIN(P200))
G1 Z-.25
G0 Z.5
P200=P200+90
IF P200<360 THEN GOTO 100
M2
