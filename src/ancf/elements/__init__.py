"""The mathematics of the elements: shape functions, strain measures, forces and tangents."""
