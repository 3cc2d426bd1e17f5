"""Free parameters: transforms, bounds, priors."""
