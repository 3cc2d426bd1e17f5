"""Ctrl-C and SIGTERM, which schedulers of clusters send before they kill: both stop a command, and it says what is kept."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_asked = threading.Event()


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Within it both signals raise KeyboardInterrupt, which callbacks of libraries may swallow: see `stop_if_asked`."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(*_: object) -> None:
        _asked.set()
        raise KeyboardInterrupt

    _asked.clear()
    before = {one: signal.signal(one, stop) for one in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


def asked_to_stop() -> bool:
    """Whether a signal has come."""
    return _asked.is_set()


def stop_if_asked() -> None:
    """Raises KeyboardInterrupt where a signal has come and did not stop what was running."""
    if asked_to_stop():
        raise KeyboardInterrupt
