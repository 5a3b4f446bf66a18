"""Roles of the people at the screens, each of which may do what those before it may."""

from enum import IntEnum


class Role(IntEnum):
    """What a person may do."""

    VIEW = 0
    OPERATE = 1
    SETUP = 2
    SERVICE = 3

    @property
    def word(self) -> str:
        """The name as screens and scripts write it."""
        return self.name.lower()

    @classmethod
    def of(cls, word: str) -> "Role":
        """The role of this name; ValueError if there is none."""
        for role in cls:
            if role.word == word:
                return role
        raise ValueError(f"{word!r} is not one of {', '.join(role.word for role in cls)}")
