(LinuxCNC style: a row of holes by a subroutine)
o<hole> sub
 G0 X#1 Y#2
 G1 Z[0 - #3] F100
 G0 Z2
o<hole> endsub
G21 G90
G0 Z2
#<n> = 0
o100 while [#<n> LT 4]
 o<hole> call [#<n> * 10 + 5] [5] [3]
 #<n> = [#<n> + 1]
o100 endwhile
M2
