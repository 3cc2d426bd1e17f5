"""A new campaign from data files: columns, units, kinds of tests and released motions are guessed."""
