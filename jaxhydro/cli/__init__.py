"""The command line: app, options, parsing, console."""
