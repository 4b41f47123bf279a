"""Scans on the map: where each pixel lies on the ground, and how sure that is."""
