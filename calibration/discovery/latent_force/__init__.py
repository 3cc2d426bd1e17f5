"""Latent force: the force that a model lacks, in time, and a law for it."""
