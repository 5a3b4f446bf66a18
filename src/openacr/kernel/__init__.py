"""The servo tick: everything the card does in one servo period.

Rooms, from the tick down; those further down know nothing of those above:

    tick_cy     the order of the card                 path       coordinated moves
    status      limits, flags, samples                sources    pulses and time for others
    followers   gears, cams, offsets, objects         axis       inputs, setpoints, servo, drive
    jog         jogs and homing                       profile, words_cy

The functions get the state of the card as views of its one buffer:

    F   64-bit floats: hidden rows of positions, speeds, times, user variables P0 to P4095
    I   32-bit integers: hidden rows of states and choices, LONG parameters, flag words
    S   32-bit floats: FP32 parameters
    U   bytes: texts, which only the scanner of part programs reads

A place is `family.row[object]`, where `openacr.map.rows` names families and rows; an array row has
its elements from there on. A flag is `I[word.word[object]] & word.FLAG` of `openacr.map.words`,
where mf1 to mf4 are the words of a master, af1 to af6 those of an axis, sf4 that of a slave, ef
of an encoder, cmf of a commutator, mo of outputs:

    F[masters.origin_u[m]]      I[moves.plane[record] + 2]      I[mf1.word[m]] & mf1.IN_MOTION

Indices have the same letters everywhere:

    m   master, 0 to 15                  e   encoder, 0 to 23
    n   axis, 0 to 15 (in profile/:      s   slave of a master, 0 to 15
        profile, 0 to 47)                t   tap of a source, trigger
    record   move, 0 to 767              b   table of a cam or ballscrew
    c   commutator, channel              k   anything else that is counted

Suffixes give the units of rows and of what is computed from them:

    _u     programming units            _cnt               pulses (counts)
    _ups   units per second             _cps               pulses per second
    _ups2  units per second squared     _cps2              pulses per second squared
    _ups3  units per second cubed       _cps3              pulses per second cubed
    _v2    squared velocity             _s _tk _hz         seconds, ticks, per second
    _deg _rad                           _v _a              volts, amperes

Numbers without a unit have no suffix: parts of a path (`part`, `rest`), factors, signs. In profile/
`_u` is the unit of the owner of a profile: programming units for masters, pulses for axes.
"""
