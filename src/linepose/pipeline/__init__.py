"""From a platform's files to its calibration, and how results are written and read."""
