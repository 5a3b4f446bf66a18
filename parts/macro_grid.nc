; A macro called in two loops: a grid of square pads, each larger than the one before.
G20 G90 G17
F40
G0 Z.2
P210=0 ; column
N10 P211=0 ; row
N20 G65 P1000 X(P210*1.5) Y(P211*1.5) Z-.05 D(.4+.1*(P210+3*P211))
P211=P211+1
IF P211<2 THEN GOTO 20
P210=P210+1
IF P210<3 THEN GOTO 10
G0 X0 Y0
M2

; Square around #1 #2 with the side #7, #3 deep: # are the arguments of this call alone.
N1000 G0 X(#1-#7/2) Y(#2-#7/2)
G1 Z#3
X(#1+#7/2)
Y(#2+#7/2)
X(#1-#7/2)
Y(#2-#7/2)
G0 Z.2
RET
