"""The sea: dispersion, spectra, and the frozen list of wave components that a simulation meets."""
