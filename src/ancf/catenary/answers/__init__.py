"""What a run along a line tells: records, statistics, verdicts, tables."""
