; A letter R cut with a drag knife: axis A looks along the path (M595). The store says which axis
; that is: openacr sysvar import parts/knife.toml
G21 G90 G17 G200 F2
F1200
G0 Z3
M595
G0 X0 Y0
G1 Z-1
Y40
X15
G2 X15 Y20 I15 J30
G1 X0
G0 Z3
X12 Y20
G1 Z-1
X25 Y0
G0 Z3
M596
X0 Y0
M2
