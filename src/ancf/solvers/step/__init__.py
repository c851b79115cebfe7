"""What an implicit step is made of: its memory and scheme, its matrix, corrections and what they lack."""
