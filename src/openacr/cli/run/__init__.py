"""`openacr run` and `openacr replay`: a project in simulated time, shown and recorded."""
