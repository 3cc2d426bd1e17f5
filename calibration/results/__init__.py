"""Result files: writing, and reading back."""
