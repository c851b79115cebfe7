"""Joints and springs between points."""
