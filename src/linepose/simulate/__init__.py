"""Surveys with a known truth: what a platform would record."""
