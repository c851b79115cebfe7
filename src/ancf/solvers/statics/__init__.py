"""Static equilibrium: load steps, corrections, and what slack, turning and sliding needs besides."""
