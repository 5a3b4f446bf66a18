"""Hidden rows of user memory: what is dimensioned, and where locals lie in the heap.

Instances 0-15 are the programs, 16-23 the PLCs. A base is an index into the view of its
type: LV and all tables into I, SV into S, DV into F; a count of 0 means not dimensioned.

Numeric arrays: `la_base` is the table of references, one int32 per array, holding the
index (into I) of the array's header or 0. The header is one int32 with the number of
elements; they follow directly: LA in I and SA in S from header + 1, DA in F from
(header + 1) / 2 (headers of DA lie at odd indices). Strings are kept outside the buffer.
"""

from openacr.map.hidden.block import HiddenBlock

STREAMS = 9

PROGRAM_STORAGE = HiddenBlock(
    prefix="ST", family="storage",
    count=24,
    ints=(
        "size_bytes",
        "is_share",  # 1: automatic share, no dimension
        "code_bytes",
        "lv_base", "lv_count",
        "sv_base", "sv_count",
        "dv_base", "dv_count",
        "la_base", "la_count",
        "sa_base", "sa_count",
        "da_base", "da_count",
        "mbuf_count",
    ),
    ranges={
        "mbuf_count": (0, 512),
        "size_bytes": (0, 1 << 30),
        "code_bytes": (0, 1 << 30),
    },
)  # fmt: skip

SYSTEM_STORAGE = HiddenBlock(
    prefix="SM",
    family="system_storage",
    count=1,
    ints=(
        "def_count",  # aliases there is space for
        ("stream_bytes", STREAMS),
    ),
)
