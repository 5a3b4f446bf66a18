; Finds the lower left corner of a block with a probe and makes it the zero of G54, then marks it.
; Needs a probe: P600000 is its input (24), P600006 is true where it is wired to 25 for Y, too.
; The ball of the probe has a radius of .125 inch. Begin left of and below the corner, tip at its side.
G20 G90 G17
G53 ; machine coordinates
P210=.125
G31 X2 F20 ; to the right until the left side is touched
IF P329=0 THEN GOTO 900
G10 L2 P1 X(P101+P210)
G0 X(P101-.25)
G31 Y2 F20 ; and from below
IF P329=0 THEN GOTO 900
G10 L2 P1 Y(P102+P210)
G0 Y(P102-.25)
Z1
G54
G0 X0 Y0
G0 Z.1
G1 Z-.02 F10
G0 Z1
M2
N900 (MSG, nothing was touched: is there a block?)
G0 Z1
M2
