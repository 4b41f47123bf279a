"""How numerical kernels are compiled, and their compiled code kept on disk."""
