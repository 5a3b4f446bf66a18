"""Work of other processes: reading whole programs, so that the control thread keeps its pace."""
