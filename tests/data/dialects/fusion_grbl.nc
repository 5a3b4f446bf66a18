(1001)
(Machine)
(  vendor: Autodesk)
(T1  D=3.175 CR=0 - ZMIN=-1 - flat end mill)
G90 G94
G17
G21
(When using Fusion for Personal Use, the feedrate of rapid)
G28 G91 Z0
G90
T1
S10000 M3
G54
G0 X3 Y0
Z15
G1 Z-1 F100
X30 F500
M5
M30
