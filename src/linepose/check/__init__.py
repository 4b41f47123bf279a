"""What can be known of a platform before a run: each concern a file of pure functions that give findings."""
