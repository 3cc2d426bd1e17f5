"""Files of other programs of the field, read into plain arrays."""
