"""Hulls as panels: geometry, files, clipping, shapes, hydrostatics."""
