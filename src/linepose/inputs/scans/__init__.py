"""Scans and the time stamps of their lines, as cameras record them."""
