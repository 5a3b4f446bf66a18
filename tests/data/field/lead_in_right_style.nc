; a round hole of 20 inches: a tool of 4 on the right, as the AcroMill guide writes it
G20 G90 G17 G40 G200 F2
G10 L12 P1 R2
T2 M6
M3 S900
G0 X0 Y5
G0 Z1
G1 Z-.5 F10
G42 D1 G1 X5
G2 X10 Y0 I5 J0 F20
G2 X10 Y0 I0 J0
G2 X5 Y-5 I5 J0
G40 G1 X0
G0 Z1
M5
M2
