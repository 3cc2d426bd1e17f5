"""OpenFAST input files: one file for each of OpenFAST's modules."""
