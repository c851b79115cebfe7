"""Pictures, moving pages and files of results; nothing in the core imports it at its start.

Figures and movies need the extra `plot`, the page of ``ancf view`` the extra `view`, exports need none.
"""
