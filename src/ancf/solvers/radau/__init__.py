"""Radau IIA: steps of variable length with several stages, for equations of motion of index 3."""
