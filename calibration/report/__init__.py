"""HTML pages, tables and sentences for people."""
