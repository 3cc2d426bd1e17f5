"""Runs of a sweep on the cores or GPUs of this machine, in processes that are restarted where killed."""

import json
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

from jaxhydro.sweep.worker import RunsDone, environment, fail_runs

TRIES = 3  # processes that one batch may end, before its runs are given up


class Worker:
    """Process that simulates runs, with its pipes."""

    def __init__(self, folder: Path, device: str | None) -> None:
        self.folder, self.device, self.ended = folder, device, False
        self.process = self._started()

    def _started(self) -> "subprocess.Popen[str]":
        command = [sys.executable, "-m", "jaxhydro.sweep.worker", str(self.folder)]
        # a session of its own: a key pressed in the terminal stops this process only, which ends the others
        self.words = tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace")  # noqa: SIM115
        return subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.words,
            text=True,
            env=environment(self.device),
            start_new_session=True,
        )

    def ask(self, numbers: Sequence[int]) -> RunsDone:
        """Simulate and store runs; a killed process is replaced, and its runs are repeated."""
        message = ""
        for _ in range(TRIES):
            process = self.process
            assert process.stdin and process.stdout
            try:
                process.stdin.write(json.dumps(list(numbers)) + "\n")
                process.stdin.flush()
                if answer := process.stdout.readline():
                    return [(number, done) for number, done in json.loads(answer)]
            except BrokenPipeError:
                pass
            message = self._last_words()
            if self.ended:
                return []
            self.process = self._started()
        return fail_runs(str(self.folder), numbers, f"the process that simulated it ended {TRIES} times ({message})")

    def _last_words(self) -> str:
        code = self.process.wait()
        if code < 0:
            return signal.Signals(-code).name
        self.words.seek(0)
        lines = self.words.read().strip().splitlines()
        return lines[-1][:300] if lines else f"exit status {code}"

    def end(self) -> None:
        """End the process for good."""
        self.ended = True
        self.process.kill()
        self.process.wait()


def simulate_locally(
    folder: Path, batches: Sequence[Sequence[int]], workers: int, devices: Sequence[str] = ()
) -> Iterator[RunsDone]:
    """Simulate batches of runs on this machine; yields each batch when it is in the store.

    Args:
        folder: Folder of the sweep.
        batches: Numbers of the runs of each batch.
        workers: Largest number of processes.
        devices: GPU of each process; empty: CPU.
    """
    waiting: queue.SimpleQueue[Sequence[int]] = queue.SimpleQueue()
    for batch in batches:
        waiting.put(batch)
    answers: queue.SimpleQueue[RunsDone | BaseException] = queue.SimpleQueue()
    every = [Worker(folder, devices[i] if devices else None) for i in range(min(workers, len(batches)))]
    stopped = threading.Event()

    def serve(worker: Worker) -> None:
        try:
            while not stopped.is_set():
                answers.put(worker.ask(waiting.get_nowait()))
        except queue.Empty:
            pass
        except BaseException as error:
            answers.put(error)

    threads = [threading.Thread(target=serve, args=(worker,), daemon=True) for worker in every]
    try:
        for thread in threads:
            thread.start()
        for _ in batches:
            answer = answers.get()
            if isinstance(answer, BaseException):
                raise answer
            yield answer
    finally:
        stopped.set()
        for worker in every:
            worker.end()
