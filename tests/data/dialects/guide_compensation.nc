; from the pages of the guide: compensation
G200 F2
G17 G20 G90
F20
G41 D1 G1 X0 Y0
X1
Y1
G40 X0 Y1
M2
