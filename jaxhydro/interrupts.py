"""Ctrl-C and SIGTERM: how a command stops and reports what is saved."""

import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from types import FrameType

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM)
GARBAGE_COLLECTION_CALLBACK = (
    "_xla_gc_callback"  # of JAX, called wherever memory is collected: what is raised in it is printed and lost
)
RETRY_DELAY = 0.05  # s
_asked = threading.Event()
_pending = threading.Event()  # asked, and nobody has dealt with it yet


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Context in which the stop signals raise KeyboardInterrupt.

    Where it would be lost, it is raised a little later. Where other code may swallow it, see `stop_if_asked`.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        _asked.set()
        _pending.set()
        if frame is not None and frame.f_code.co_name == GARBAGE_COLLECTION_CALLBACK:
            threading.Timer(RETRY_DELAY, signal.raise_signal, [number]).start()
            return
        raise KeyboardInterrupt

    _asked.clear()
    _pending.clear()
    before = {stop_signal: signal.signal(stop_signal, stop) for stop_signal in STOP_SIGNALS}
    try:
        yield
    finally:
        for stop_signal, handler in before.items():
            signal.signal(stop_signal, handler)


def finished() -> None:
    """Ignore signals until the end of `ended_by_signals`: all is written."""
    if threading.current_thread() is threading.main_thread():
        for stop_signal in STOP_SIGNALS:
            signal.signal(stop_signal, signal.SIG_IGN)


def asked_to_stop() -> bool:
    """Whether a signal has come."""
    return _asked.is_set()


def stop_if_asked() -> None:
    """Raise KeyboardInterrupt if a signal came that stopped nothing; for long loops."""
    if _pending.is_set():
        raise KeyboardInterrupt


def stopping() -> None:
    """Shield the end of a stopped loop from being stopped again, except by another signal."""
    _pending.clear()


@contextmanager
def stoppable_threads(count: int) -> Iterator[Executor]:
    """Threads whose jobs that have not begun are dropped where a stop or an error ends the block."""
    pool = ThreadPoolExecutor(count)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=True, cancel_futures=True)
        raise
    pool.shutdown()
