"""What a model lacks: the residual taken apart, candidate effects scored, refitted, judged on what was not fitted."""
