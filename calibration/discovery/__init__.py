"""Model discovery: which effects a model lacks, tested on data that were not fitted."""
