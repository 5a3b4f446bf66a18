(Exported by FreeCAD)
(Post Processor: grbl_post)
(Output Time:2026-01-02 10:11:12)
(Begin preamble)
G17 G90
G21
(Begin operation: Profile)
M3 S12000
G0 Z5.000
G0 X1.000 Y2.000
G1 X1.000 Y2.000 Z-1.000 F100.000
G1 X30.000
(Begin postamble)
M5
G17 G90
M2
