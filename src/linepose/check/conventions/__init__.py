"""The convention doctor: which of the usual mistakes explains data that do not fit the hand-measured pose."""
