"""Estimates from curves: pure functions on arrays that know nothing of robots or records."""
