"""One force, one class: what acts on the vessel, and which physical effects it covers."""
