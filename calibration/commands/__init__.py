"""Commands on campaigns: calibrate, simulate, diagnose, uncertainty."""
