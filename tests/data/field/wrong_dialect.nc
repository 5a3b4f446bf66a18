;dialect acromill
( arcs as CAM systems write them, read as positions )
G20 F20
G0 X10 Y5
G1 X12
G3 X13 Y6 I0 J1
M2
