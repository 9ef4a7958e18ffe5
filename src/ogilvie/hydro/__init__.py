"""Frequency-domain hydrodynamic coefficients: the data set, its readers and writers, the panel solver, the checks."""
