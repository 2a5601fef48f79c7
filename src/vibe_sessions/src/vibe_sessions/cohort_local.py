"""The sessions of a cohort on the cores of this machine."""
import concurrent.futures
import itertools
import threading

from vibe_sessions.headless import Killed, SessionError, Stopped

ATTEMPTS = 3  # the first and two more


def perform_patiently(session, stopped, work):
    """(row or None, reason). Again, in a new process, if the child was killed."""
    for _ in range(ATTEMPTS):
        try:
            return work(session, stopped), ""
        except Killed as error:
            death = str(error)
        except Stopped:
            return None, "Stopped."
        except SessionError as error:
            return None, str(error)
        except Exception as error:  # pylint: disable=broad-except
            return None, f"{type(error).__name__}: {error}"
    return None, f"{death} Tried {ATTEMPTS} times."


def run_local(sessions, jobs, work):
    """Yields (session, row or None, reason) as sessions end; closing the generator ends what is under way."""
    sessions, halt = iter(sessions), threading.Event()
    with concurrent.futures.ThreadPoolExecutor(jobs) as crew:
        running = {}

        def launch(count):
            for session in itertools.islice(sessions, count):
                running[crew.submit(perform_patiently, session, halt.is_set, work)] = session

        try:
            launch(jobs)
            while running:
                for done in concurrent.futures.wait(running, return_when="FIRST_COMPLETED").done:
                    session = running.pop(done)
                    launch(1)
                    yield session, *done.result()
        finally:
            halt.set()
