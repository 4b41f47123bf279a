"""What people and other programs take away: report, figures, exports."""
