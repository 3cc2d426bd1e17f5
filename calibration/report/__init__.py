"""HTML pages, tables and sentences of the results."""
