"""The sessions of a cohort on the workers of a Dask scheduler."""
import contextlib
import itertools
import logging
import uuid

from distributed import Client, as_completed, get_worker
from distributed.scheduler import KilledWorker

from vibe_sessions.headless import Killed, SessionError

ATTEMPTS = 3  # the first and two more
PATIENCE = 30  # for the scheduler and for the first worker [s]


def perform_on_worker(session, work):
    """Runs on a worker: (row or None, reason, address of the worker if the child was killed there)."""
    worker = get_worker()
    key = worker.get_current_task()

    def stopped():
        task = worker.state.tasks.get(key)
        return task is None or task.state == "cancelled"

    try:
        return work(session, stopped), "", None
    except Killed as death:
        return None, str(death), worker.address
    except SessionError as error:
        return None, str(error), None


def hush():
    """Dask's own words, tracebacks among them, do not reach the user."""
    for name in list(logging.root.manager.loggerDict):
        if name.split(".")[0] in ("distributed", "tornado", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


def connect(address):
    hush()
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError):
        raise SessionError(f"No Dask scheduler answers at '{address}'; start one with `dask-scheduler`.") from None
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except Exception:  # the type differs between versions of Dask
        client.close()
        raise SessionError(f"The scheduler at '{address}' has no worker; start one: `dask-worker {address}`.") from None
    return client


class _Flight:
    """Sessions on their way. Few are at any time, however many there are."""

    def __init__(self, client, sessions, jobs, work):
        self._client, self._sessions, self._jobs, self._work = client, iter(sessions), jobs, work
        self._run, self._futures = uuid.uuid4().hex[:8], as_completed(loop=client.loop)
        self._session, self._attempt = {}, {}  # by the key of the future

    def launch(self, session, attempt=1, avoid=None):
        others = [worker for worker in self._client.scheduler_info()["workers"] if worker != avoid] if avoid else []
        key = f"{session.key}-{self._run}-{attempt}"
        future = self._client.submit(perform_on_worker, session, self._work, key=key, pure=False, workers=others or None,
                                     allow_other_workers=bool(others))
        self._session[key], self._attempt[key] = session, attempt
        self._futures.add(future)

    def fill(self):
        """As many as the present workers can use, and as many again that wait."""
        workers = self._client.scheduler_info()["workers"].values()
        count = self._jobs or 2 * sum(worker["nthreads"] for worker in workers)
        for session in itertools.islice(self._sessions, max(1, count - len(self._session))):
            self.launch(session)

    def _outcome(self, future):
        if future.status == "cancelled":
            raise SessionError("The connection to the Dask scheduler was lost; what is done is kept, start the "
                               "scheduler and call again.")
        try:
            return future.result()
        except KilledWorker:
            return None, "Workers were killed while they performed the session.", ""
        except Exception as error:  # pylint: disable=broad-except
            return None, f"{type(error).__name__}: {error}", None

    def results(self):
        for future in self._futures:
            session, attempt = self._session.pop(future.key), self._attempt.pop(future.key)
            row, reason, killed_at = self._outcome(future)
            future.release()
            if killed_at is not None and attempt < ATTEMPTS:
                self.launch(session, attempt + 1, killed_at)
                continue
            self.fill()
            yield session, row, reason + (f" Tried {attempt} times." if killed_at is not None else "")

    def end(self):
        with contextlib.suppress(Exception):  # the scheduler may be gone
            if self._client.status == "running":
                self._client.cancel(list(self._futures.futures), force=True)


def run_dask(sessions, address, jobs, work):
    """Yields (session, row or None, reason) as sessions end; closing the generator cancels what is under way.

    Args:
        jobs: sessions that are handed out at a time; 0: two per thread of the workers
    """
    client = connect(address)
    try:
        flight = _Flight(client, sessions, jobs, work)
        flight.fill()
        try:
            yield from flight.results()
        finally:
            flight.end()
    finally:
        with contextlib.suppress(Exception):
            client.close()
