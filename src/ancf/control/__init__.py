"""Runs that something else leads: inputs, steps one by one, controllers."""
