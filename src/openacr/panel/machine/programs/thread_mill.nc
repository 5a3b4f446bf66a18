; Internal thread M20 x 1.5, 12 mm deep, milled upwards on a helix with cutter compensation.
; The cutter has 12 mm (D3); change its wear until the gauge fits. Zero is the centre, on top.
G21 G90 G17 G200 F2
G10 L12 P3 R6
P200=10  ; radius of the thread
P201=1.5 ; pitch
P202=12  ; depth
G0 X0 Y0 Z5
S2500 M3
G1 Z(-P202) F500
G41 D3 X2 Y-8 F150 ; lead-in inside the hole, a quarter of a circle
G3 X(P200) Y0 I2 J0
P203=-P202
N10 P203=P203+P201
G3 X(P200) Y0 Z(P203) I0 J0 ; one turn rises by the pitch
IF P203<0 THEN GOTO 10
G3 X2 Y8 I2 J0
G40 G1 X0 Y0
G0 Z5
M5
M2
