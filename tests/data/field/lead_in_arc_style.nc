%
(the same plate, conventional cut, tool of 6 mm on the right, an arc as the way in)
G90 G94 G17 G91.1 G21 G40
T3 M6
S8000 M3
G0 X-8. Y18.
G0 Z2.
G1 Z-1. F100.
G42.1 D6.
G2 X0. Y10. I0. J-8. F500.
G1 Y0.
X30.
Y20.
X0.
Y10.
G2 X-8. Y2. I-8. J0.
G40 G1 X-16.
G0 Z20.
M5
M30
%
