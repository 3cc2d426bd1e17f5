"""Platform files: their schema, and the models made of them."""
