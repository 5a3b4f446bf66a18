"""Counts in messages: a number with its noun in the right form."""


def counted(cnt: int, noun: str) -> str:
    """A count with its noun: `1 error`, `2 errors`, `1 entry`, `2 entries`."""
    if cnt == 1:
        return f"1 {noun}"
    ends_in_y = noun.endswith("y") and noun[-2:-1] not in "aeiou"
    return f"{cnt} {noun[:-1]}ies" if ends_in_y else f"{cnt} {noun}s"
