"""What programs do to a simulation besides stepping it; each returns sentences about what was wrong."""

import gc
import os
import pickle
import threading

import numpy as np

import vibe


def _advance(simulation, steps, given):
    simulation.run(steps, **given)
    return simulation.hash()


def snapshots(simulation, random):
    """The future after a snapshot, restored as it is, prepared, and pickled, is one future of one input."""
    steps, given = int(random.integers(1, 20)), simulation.input
    kept = [simulation.snapshot(), simulation.snapshot(prepared=True), pickle.loads(pickle.dumps(simulation.snapshot()))]
    hashes = {_advance(simulation, steps, given)}
    for snapshot in kept:
        simulation.restore(snapshot)
        hashes.add(_advance(simulation, steps, given))
    return [] if len(hashes) == 1 else ["snapshots have different futures"]


def views(simulation, random):
    """Views of a simulation that is closed, and of one that is gone, stay as they were."""
    wrong = []
    for close in (True, False):
        other = vibe.Simulation(simulation.model, metrics=False, impedance=False)
        other.run(int(random.integers(1, 5)), insertion=0.05, insufflate=True)
        shown = [other.x, other.vz, other.heat, other.model.triangles]
        copies = [view.copy() for view in shown]
        if close:
            other.close()
        del other
        gc.collect()
        if not all(np.array_equal(view, copy) for view, copy in zip(shown, copies)):
            wrong.append("a view changed when its simulation was gone")
    return wrong


def two_threads(simulation, random):
    """The second thread is refused or served between two calls; nothing else."""
    errors, wrong = set(), []
    runner = threading.Thread(target=simulation.run, args=(int(random.integers(5, 60)),))
    runner.start()
    while runner.is_alive():
        for call in (simulation.hash, lambda: simulation.x.sum(), simulation.snapshot, lambda: simulation.camera(4, 4)):
            try:
                call()
            except vibe.Error as error:
                errors.add(str(error))
    runner.join()
    if any("another thread" not in error for error in errors):
        wrong.append(f"two threads: {errors}")
    return wrong


def threads(simulation, random):
    """As many simulations of one model as there are threads, each with the bits that it has alone."""
    states = [vibe.Simulation(simulation.model, metrics=False, impedance=False) for _ in range(3)]
    start, steps, given = simulation.snapshot(), int(random.integers(2, 20)), simulation.input
    hashes = [0] * len(states)

    def work(k):
        states[k].restore(start)
        hashes[k] = _advance(states[k], steps, given)

    workers = [threading.Thread(target=work, args=(k,)) for k in range(len(states))]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return [] if len(set(hashes)) == 1 else ["threads have different futures"]


def fork(simulation, random):
    """A child may not use the simulation, but may make another one of the model."""
    model, child = simulation.model, os.fork()
    if child == 0:
        status = 1
        try:
            simulation.step()
        except vibe.Error:
            own = vibe.Simulation(model, metrics=False, impedance=False)
            own.run(int(random.integers(1, 4)), insufflate=True)
            status = 0 if np.isfinite(own.positions).all() else 2
        finally:
            os._exit(status)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return [] if status == 0 else [f"a child of fork() ended with {status}"]


def of(environment, random):
    """One of these, of the simulation of an environment as it is now."""
    simulation = environment.simulation
    return (snapshots, views, two_threads, threads, fork)[int(random.integers(5))](simulation, random)
