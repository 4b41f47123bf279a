"""Rotations, poses, cameras, planes and distances: pure functions of arrays."""
