"""Central differences with the factorised mass matrix."""
