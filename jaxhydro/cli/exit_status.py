"""Exit statuses of the commands; 0: done."""

BAD_INPUT, NOT_CONVERGED, STOPPED = 2, 3, 130
