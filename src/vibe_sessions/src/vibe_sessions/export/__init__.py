"""Recorded sessions in the formats of others."""
