%
(outside of a plate 30 x 20, climb cut, tool of 6 mm on the left, quarter circles as leads)
G90 G94 G17 G91.1 G21 G40
T3 M6
S8000 M3
G0 X-16. Y2.
G0 Z2.
G1 Z-1. F100.
G41.1 D6. G1 X-8. F500.
G3 X0. Y10. I0. J8.
G1 Y20.
X30.
Y0.
X0.
Y10.
G3 X-8. Y18. I-8. J0.
G40 G1 X-16.
G0 Z20.
M5
M30
%
