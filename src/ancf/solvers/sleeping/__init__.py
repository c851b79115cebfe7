"""Steps of lines of which parts sleep: far from what moves, reduced to their modes."""
