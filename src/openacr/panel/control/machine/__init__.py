"""The machine of a panel: where it is, its session, its pace and its past."""
