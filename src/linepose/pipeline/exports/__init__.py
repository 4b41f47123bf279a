"""What a format of export is, and a calibration written in one. The formats themselves are entry points."""
