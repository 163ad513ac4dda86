"""Follows the unknowns of a chain, observation by observation; knows nothing of any robot."""
