"""Jobs forked from a process that has loaded their libraries, which are so loaded once a run."""
