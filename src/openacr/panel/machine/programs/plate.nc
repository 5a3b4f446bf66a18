; Plate 80 x 50 mm: pocket, four holes, outline. Zero is the lower left corner, on the surface.
; T1 is a 6 mm cutter (radius in D1), T2 a 5 mm drill (length in H2).
G21 G90 G17 G40 G49 G200 F2
G10 L12 P1 R3 ; radius of D1, here so that the program runs anywhere

; --- pocket 40 x 20 with corners of 5 mm, 4 mm deep, cutter inside: G41, counter-clockwise
T1 M6
S3000 M3
M8
G0 X40 Y25
Z2
P200=0 ; depth reached
N100 P200=P200+2
G1 Z(-P200) F100
G1 X27 Y22 F300 ; clear the middle
X53
Y28
X27
Y22
X40 Y25
G41 D1 X34 Y21 ; lead-in: line and a quarter that touches the edge
G3 X40 Y15 I40 J21
G1 X55
G3 X60 Y20 I55 J20
G1 Y30
G3 X55 Y35 I55 J30
G1 X25
G3 X20 Y30 I25 J30
G1 Y20
G3 X25 Y15 I25 J20
G1 X40
G3 X46 Y21 I40 J21
G40 G1 X40 Y25
IF P200<4 THEN GOTO 100
G0 Z10

; --- outline, 3 mm deep, cutter outside: G41, clockwise
G0 X-20 Y17
Z2
G1 Z-3 F100
G41 D1 X-8 Y17 F300
G3 X0 Y25 I-8 J25
G1 Y50
X80
Y0
X0
Y25
G3 X-8 Y33 I-8 J25
G40 G1 X-20 Y33
G0 Z10
M9

; --- holes
T2 M6
S2000 M3
G43 H2
G98 G81 X8 Y8 Z-10 R2 F120
X72
Y42
X8
G80 M5
G0 Z10
M2
$I CYCLES.TXT
