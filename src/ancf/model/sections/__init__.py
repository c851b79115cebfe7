"""Cross-sections: stiffness, mass, damping, and the integrals over shapes that these come from."""
