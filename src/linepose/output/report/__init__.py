"""The report: what a field engineer reads first."""
