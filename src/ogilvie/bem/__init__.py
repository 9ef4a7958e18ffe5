"""Time-domain hybrid panel method: Rankine panels inside a control hemisphere, the open sea outside it."""
