"""CiA 402, the profile of drives: its objects, its states and how a master leads a drive."""
