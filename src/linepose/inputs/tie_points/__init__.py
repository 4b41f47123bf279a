"""Tie points that nobody labels: features of rectified strips, matched where strips overlap, led back to raw scans."""
