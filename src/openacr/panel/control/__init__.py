"""The control thread: the machine, its pace in real time, and what operators hold."""
