; A waved surface z = 0.15 sin(x) cos(y) - 0.15, angles 90 degrees per inch, cut in rows.
; The cutter is a ball of 1/4 inch; this is the path of its tip.
G20 G90 G17 G64
G10 L12 P1 R.125 ; radius of D1
D1
F60
P200=0     ; row
P201=0.125 ; step
P202=1     ; direction
G0 X0 Y0 Z.25
N10 P203=P200*P201 ; y
P204=0
IF P202=1 THEN GOTO 20
P204=4
N20 G1 X(P204) Y(P203) Z(.15*SIN(90*P204)*COS(90*P203)-.15)
P204=P204+P202*P201
IF P204<-.0001 THEN GOTO 30
IF P204<=4.0001 THEN GOTO 20
N30 P202=-P202
P200=P200+1
IF P200*P201<=2.0001 THEN GOTO 10
G0 Z.25
M2
