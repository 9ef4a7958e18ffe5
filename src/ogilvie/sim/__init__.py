"""The vessel in time: equations of motion, integrators, simulation."""
