"""Training sets in the formats of the field, written an episode at a time, whole or not at all. Needs no ROS."""
