"""After the run: statistics, figures, report."""
