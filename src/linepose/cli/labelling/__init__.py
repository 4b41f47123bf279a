"""Labelling pattern points by hand: a window over each scan, in which the points are clicked in their order."""

from linepose.cli.labelling.run import label, label_platform

__all__ = ["label", "label_platform"]
