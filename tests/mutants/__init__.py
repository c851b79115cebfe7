"""Mutation of the package: one-line changes, and the tests that must fail with each of them."""
