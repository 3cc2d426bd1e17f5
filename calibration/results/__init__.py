"""Result files, written and read back."""
