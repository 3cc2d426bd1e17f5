"""The commands on campaigns."""
