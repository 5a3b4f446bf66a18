"""How the arguments of a command are written, and what its handler gets for them.

A form reads one argument (`parse`, when the line is read) and later turns what it read
into the value the handler gets (`evaluate`, when the command is executed). Forms are
listed in the row of a command in the order in which they are written; an optional one
that is left out gives None.
"""

from openacr.basic.language.form import Form
from openacr.basic.language.grammar.axes import (
    Axes,
    AxisGroups,
    AxisItem,
    AxisList,
    AxisPairs,
    AxisTargets,
    AxisValues,
    TargetItem,
)
from openacr.basic.language.grammar.combined import Command, Either, Repeat, Rest
from openacr.basic.language.grammar.flags import Bit, BitItem, Bits, ParameterName
from openacr.basic.language.grammar.forms import (
    Condition,
    Expression,
    Group,
    Int,
    Lvalue,
    Mark,
    Num,
    Pair,
    Str,
    Word,
)
from openacr.basic.language.grammar.objects import Object, Source, Target
from openacr.basic.language.grammar.values import (
    Axis,
    AxisTarget,
    AxisValue,
    BitState,
    ObjectRef,
    SignedParameter,
)

__all__ = [
    "Axes",
    "Axis",
    "AxisGroups",
    "AxisItem",
    "AxisList",
    "AxisPairs",
    "AxisTarget",
    "AxisTargets",
    "AxisValue",
    "AxisValues",
    "Bit",
    "BitItem",
    "BitState",
    "Bits",
    "Command",
    "Condition",
    "Either",
    "Expression",
    "Form",
    "Group",
    "Int",
    "Lvalue",
    "Mark",
    "Num",
    "Object",
    "ObjectRef",
    "Pair",
    "ParameterName",
    "Repeat",
    "Rest",
    "SignedParameter",
    "Source",
    "Str",
    "Target",
    "TargetItem",
    "Word",
]
