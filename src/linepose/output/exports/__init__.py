"""A finished calibration taken away: one format a file, found by the entry points of `linepose.pipeline.exports`."""
