"""The sessions of a cohort on the cores of this machine."""
import queue
import threading

from vibe_sessions.cohort_session import perform
from vibe_sessions.headless import Killed, SessionError, Stopped

ATTEMPTS = 3  # the first and two more


def perform_patiently(session, stopped):
    """Again, in a new process, if the child was killed."""
    for attempt in range(ATTEMPTS):
        try:
            return perform(session, stopped)
        except Killed as death:
            if attempt == ATTEMPTS - 1:
                raise SessionError(f"{death} Tried {ATTEMPTS} times.") from None


class _Crew:
    """Threads that each wait for one child at a time."""

    def __init__(self, sessions, jobs):
        self._sessions, self._lock = iter(sessions), threading.Lock()
        self._results = queue.Queue(maxsize=2 * jobs)  # what nobody has fetched yet is limited
        self._halt = threading.Event()
        self._threads = [threading.Thread(target=self._work, daemon=True) for _ in range(jobs)]

    def _work(self):
        while not self._halt.is_set():
            with self._lock:
                session = next(self._sessions, None)
            if session is None:
                break
            try:
                self._results.put((session, perform_patiently(session, self._halt.is_set), ""))
            except SessionError as error:
                self._results.put((session, None, str(error)))
            except Stopped:
                break
            except Exception as error:  # pylint: disable=broad-except
                self._results.put((session, None, f"{type(error).__name__}: {error}"))
        self._results.put(None)

    def results(self):
        for thread in self._threads:
            thread.start()
        left = len(self._threads)
        while left > 0:
            result = self._results.get()
            if result is None:
                left -= 1
            else:
                yield result

    def end(self):
        """Ends the children and waits for the threads."""
        self._halt.set()
        while any(thread.is_alive() for thread in self._threads):
            try:
                self._results.get(timeout=0.1)
            except queue.Empty:
                pass


def run_local(sessions, jobs):
    """Yields (session, row or None, reason) as sessions end; closing the generator ends what is under way."""
    crew = _Crew(sessions, jobs)
    try:
        yield from crew.results()
    finally:
        crew.end()
