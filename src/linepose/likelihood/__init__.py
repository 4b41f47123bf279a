"""Noise models of the reprojected points (Eq. 11-22): each a file, all behind one class."""
