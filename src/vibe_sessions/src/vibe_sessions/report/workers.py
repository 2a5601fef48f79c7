"""Recordings are read one by one in worker processes; whatever happens to one of them, the others go on."""

import multiprocessing
import multiprocessing.connection
import signal

TASKS = 100  # after which a worker is replaced, so that nothing it keeps can grow


def serve(pipe, work):
    """Runs in a worker: answers each argument with (True, result) or (False, reason)."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process().sentinel  # a program that is killed takes its workers with it
    while pipe in multiprocessing.connection.wait([pipe, parent]):
        argument = pipe.recv()
        if argument is None:
            return
        try:
            pipe.send((True, work(argument)))
        except Exception as error:  # of whatever kind: the recording is bad, the others are not
            pipe.send((False, "{}: {}".format(type(error).__name__, error)))


class Worker:
    def __init__(self, work):
        context = multiprocessing.get_context("fork")
        self.pipe, theirs = context.Pipe()
        self._process = context.Process(target=serve, args=(theirs, work), daemon=True)
        self._process.start()
        theirs.close()
        self._done = 0
        self.task = None

    def begin(self, task, argument):
        self.task = task
        self.pipe.send(argument)

    def answer(self):
        """(task, succeeded, result or reason) of the work that has ended."""
        self._done += 1
        try:
            succeeded, result = self.pipe.recv()
        except (EOFError, ConnectionResetError):
            self._process.join()
            self._done = TASKS
            succeeded, result = False, "the process that read it ended with status {}".format(self._process.exitcode)
        task, self.task = self.task, None
        return task, succeeded, result

    def is_worn(self):
        return self._done >= TASKS

    def end(self):
        try:
            self.pipe.send(None)
        except OSError:
            pass  # it has ended already
        self.pipe.close()
        self._process.join(5)
        if self._process.is_alive():
            self._process.kill()


def run_all(arguments, work, jobs):
    """(number, succeeded, result or reason) of work(argument) for each argument, as they end."""
    tasks = iter(enumerate(arguments))
    workers = []
    try:
        for number, argument in tasks:
            workers.append(started(work, number, argument))
            if len(workers) == jobs:
                break
        while workers:
            ready = multiprocessing.connection.wait([worker.pipe for worker in workers])
            for worker in [each for each in workers if each.pipe in ready]:
                yield worker.answer()
                following = next(tasks, None)
                if following is None or worker.is_worn():
                    workers.remove(worker)
                    worker.end()
                    if following is not None:
                        workers.append(started(work, *following))
                else:
                    worker.begin(*following)
    finally:
        for worker in workers:
            worker.end()


def started(work, number, argument):
    worker = Worker(work)
    worker.begin(number, argument)
    return worker
