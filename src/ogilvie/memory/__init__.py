"""Fluid memory: retardation functions and the state-space models that replace their convolution."""
