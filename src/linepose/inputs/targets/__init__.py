"""The board's points found in scans and refined."""
