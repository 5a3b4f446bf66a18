( pcb2gcode style, isolation of one pad )
G94 ( Millimeters per minute feed rate. )
G21 ( Units == Millimeters. )
G90 ( Absolute coordinates. )
G64 P0.01 ( path tolerance )
S20000 ( RPM spindle speed. )
M3 ( Spindle on clockwise. )
G4 P1 ( Wait for spindle to get up to speed )
G0 Z2.00000
G0 X1.00000 Y0.50000 ( rapid move to begin. )
G1 Z-0.05000 F300
G1 F600
X4.00000 Y0.50000
X4.50000 Y1.00000
X4.50000 Y2.00000
X4.00000 Y2.50000
X1.00000 Y2.50000
X0.50000 Y2.00000
X0.50000 Y1.00000
X1.00000 Y0.50000
G0 Z2.00000
M9 ( Coolant off. )
M5 ( Spindle off. )
M2 ( Program end. )
