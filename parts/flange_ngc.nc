;dialect rs274ngc
(Written for another control: O-words, named parameters, brackets, M30)
o<ring> sub
  (#1 radius, #2 holes, #3 depth)
  #4 = 0
  o100 while [#4 LT #2]
    G81 X[#1 * cos[360 * #4 / #2]] Y[#1 * sin[360 * #4 / #2]] Z[-#3] R0.1 F5
    #4 = [#4 + 1]
  o100 endwhile
  G80
o<ring> endsub

G20 G90 G17 G64 P0.001
#<safe> = 0.5
S1000 M3
G0 Z#<safe>
o<ring> call [1.5] [6] [0.4]
o<ring> call [0.75] [3] [0.2]
G0 Z#<safe>
G0 X2.5 Y0
G1 Z-0.25 F10
G3 X2.5 Y0 I-2.5 (I and J count from the start of the arc)
G0 Z#<safe>
M5
M30
