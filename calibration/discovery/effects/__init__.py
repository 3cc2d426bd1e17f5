"""The effects that a model may lack, and where a fit of each begins."""
