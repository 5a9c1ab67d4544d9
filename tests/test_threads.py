"""Threads of dense algebra, as many as are asked for, also in a library that is loaded late; and shared loops."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from multiprocessing import get_context

import pytest

from contactsim.threads import share_work

SCRIPT = """
from threadpoolctl import threadpool_info

from contactsim.contact.loading import approaches
from contactsim.contact.scene import Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.simulation import simulate
from contactsim.solvers.cohesive import zone_preconditioner
from contactsim.surfaces.shapes import Cylinder

factor = zone_preconditioner.ZonePreconditioner._factor

def count_threads(self, values):
    factor(self, values)
    seen.update(pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas")

seen = set()
zone_preconditioner.ZonePreconditioner._factor = count_threads
surface, path = Cylinder(length=10000.0, radius=25000.0), approaches([-1.0, 0.0])
scene = Scene(HalfSpace(77.0), surface, NormalCohesiveZone(2.0), path)
simulate(scene, points=256)
print(sorted(seen))
"""


def test_all_dense_algebra_of_a_path_has_one_thread():
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "4"}
    done = subprocess.run([sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[1]"


@pytest.mark.parametrize(("count", "threads"), [(0, 2), (1, 2), (5, 1), (5, 2), (7, 3), (2, 8)])
def test_every_number_of_a_shared_loop_is_done_once(count, threads):
    done = []
    share_work(done.append, count, threads)
    assert sorted(done) == list(range(count))


def test_two_threads_share_a_loop():
    meeting, names = threading.Barrier(2, timeout=10), set()

    def meet(number):
        names.add(threading.current_thread().name)
        meeting.wait()

    share_work(meet, 2, 2)
    assert len(names) == 2


def test_an_error_of_a_shared_loop_is_raised_whichever_thread_meets_it():
    for failing in range(2):
        with pytest.raises(ZeroDivisionError):
            share_work(lambda number, failing=failing: 1 / (number != failing), 2, 2)


def test_nothing_is_done_any_more_when_an_error_is_raised():
    done = []

    def work(number):
        if number == 0:
            raise ValueError("the share of this thread")
        time.sleep(0.05)
        done.append(number)

    with pytest.raises(ValueError, match="this thread"):
        share_work(work, 6, 2)
    assert done == [1, 3, 5]


def share_in_child(connection):
    done = []
    share_work(done.append, 4, 2)
    connection.send(len(done))


@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own():
    share_work(str, 4, 2)
    context = get_context("fork")
    here, there = context.Pipe()
    child = context.Process(target=share_in_child, args=(there,))
    child.start()
    assert here.poll(20)
    assert here.recv() == 4
    child.join()
