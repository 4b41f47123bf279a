"""Work on other machines than the one that plans it: what a node must have, and what SLURM says."""
