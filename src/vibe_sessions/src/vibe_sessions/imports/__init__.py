"""Recorded motions of people and of other robots, performed as sessions."""
