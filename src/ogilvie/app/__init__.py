"""The application: case files and the command line."""
