"""Commands on campaigns: init, check, calibrate, simulate, diagnose, uncertainty."""
