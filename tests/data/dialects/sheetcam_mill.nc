(Filename: gasket.tap)
(Post processor: Mach3 with scaling.scpost)
(Date: 02/01/26)
G20 (Units: Inches)
G53 G90 G40
F1
(Part: gasket)
(Operation: Outside Offset, Layer 1)
M06 T1
G00 Z0.5
M03 S1000
X1 Y0.5
Z0.1
G01 Z-0.1 F10
G02 X1.5 Y0 I0 J-0.5
M05 M30
