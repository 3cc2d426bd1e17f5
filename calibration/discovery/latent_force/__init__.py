"""The force that a model lacks, as a function of time, and a law for it."""
