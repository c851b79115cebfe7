"""The form of a line at rest: wires, lengths of droppers, what supports bear."""
