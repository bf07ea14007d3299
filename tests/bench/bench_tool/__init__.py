"""Builds the measuring programs, runs them on emulated cores and here, scores them, and writes what came out."""
