"""`openacr sweep`: a parameter study on all cores or a cluster, its table and pictures."""
