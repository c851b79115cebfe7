"""What holds and moves nodes, and winches."""
