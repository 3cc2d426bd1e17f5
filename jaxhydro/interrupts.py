"""Ctrl-C and SIGTERM, which schedulers of clusters send before they kill: both stop a command, and it says what is kept."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

BOTH = (signal.SIGINT, signal.SIGTERM)
SWALLOWING = "_xla_gc_callback"  # of JAX, called wherever memory is collected: what is raised in it is printed and lost
LATER = 0.05  # s
_asked = threading.Event()


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Within it both signals raise KeyboardInterrupt: a little later where that would be lost. What else may swallow it is for
    `stop_if_asked`."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        _asked.set()
        if frame is not None and frame.f_code.co_name == SWALLOWING:
            threading.Timer(LATER, signal.raise_signal, [number]).start()
            return
        raise KeyboardInterrupt

    _asked.clear()
    before = {one: signal.signal(one, stop) for one in BOTH}
    try:
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


def finished() -> None:
    """All is written: until the end of `ended_by_signals` signals change nothing."""
    if threading.current_thread() is threading.main_thread():
        for one in BOTH:
            signal.signal(one, signal.SIG_IGN)


def asked_to_stop() -> bool:
    """Whether a signal has come."""
    return _asked.is_set()


def stop_if_asked() -> None:
    """Raises KeyboardInterrupt where a signal has come and did not stop what was running."""
    if asked_to_stop():
        raise KeyboardInterrupt
