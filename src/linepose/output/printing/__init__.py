"""Targets as PDF, true to scale."""
