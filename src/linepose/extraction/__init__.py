"""Pattern points in scans: reading, refining and finding them."""
