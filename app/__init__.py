"""Files, sessions, pictures, the command line and the window."""
