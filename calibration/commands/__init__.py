"""Commands on campaigns: init, calibrate, simulate, diagnose, uncertainty."""
