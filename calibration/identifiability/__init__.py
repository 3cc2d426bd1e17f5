"""What records determine: information, covariance, weak directions, findings."""
