"""A set of sessions to be published: recordings, forces, contacts, deformation, pictures, splits, baselines and a card."""
