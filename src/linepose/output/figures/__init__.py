"""Figures, one a file: pure functions from result tables to a matplotlib Figure."""
