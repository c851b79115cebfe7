"""The structured solve: block-sparse factorisation of chains and nets of nodes."""
