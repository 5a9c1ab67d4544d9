"""Threads of dense algebra: as many as are asked for, also in a library that is loaded late."""

from __future__ import annotations

import os
import subprocess
import sys

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
