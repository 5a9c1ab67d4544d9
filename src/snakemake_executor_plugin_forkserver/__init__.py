"""A Snakemake executor for this machine that starts Python scripts as forks of one process.

Importing numpy, scipy, xarray and matplotlib costs a job about one second, more than most scenes take to solve. Here a
server imports them once, and each script is a fork of it. All other jobs run as in Snakemake's own local executor,
which also does all bookkeeping: `snakemake --executor local` gives the same results.
"""

from __future__ import annotations

import os
import pickle
import socket
import subprocess
import sys
from concurrent.futures import Future
from pathlib import Path
from typing import Any

from snakemake.exceptions import SpawnedJobError
from snakemake.executors.local import Executor as LocalExecutor
from snakemake.executors.local import common_settings
from snakemake.iocontainers import Snakemake
from snakemake_interface_executor_plugins.jobs import SingleJobExecutorInterface

__all__ = ["Executor", "common_settings"]

SERVER = Path(__file__).with_name("server.py")
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Linear algebra libraries read their number of threads when they are imported."""


class Executor(LocalExecutor):  # type: ignore[misc]  # Snakemake is not typed
    """Run Python scripts of one thread as forks, and all else as the local executor does."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.server: subprocess.Popen[bytes] | None = None
        self.control: socket.socket | None = None
        self.links: set[socket.socket] = set()
        self.cancelled = False
        if sys.platform == "linux":  # elsewhere a fork of a process with these libraries is not safe
            self._start_server()

    def _start_server(self) -> None:
        """Start the server; it ends when this process does, which closes the other end of its socket."""
        self.control, theirs = socket.socketpair()
        scripts = {str(path) for rule in self.workflow.rules if (path := _script_path(rule)) is not None}
        command = [sys.executable, "-P", str(SERVER), str(theirs.fileno()), *sorted(scripts)]
        with theirs:
            self.server = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                env=os.environ | ONE_THREAD,
                start_new_session=True,
            )

    def run_single_job(self, job: SingleJobExecutorInterface) -> Future[None]:
        """Start a job; return the future that ends with it."""
        lift_rate_limit(self.workflow.scheduler)
        script = _script_path(job.rule)
        if self.control is None or script is None or job.threads > 1:
            return super().run_single_job(job)  # type: ignore[no-any-return]
        self.workflow.async_run(job.prepare())
        snakemake = Snakemake(
            job.input,
            job.output,
            job.params,
            job.wildcards,
            job.threads,
            job.resources,
            job.log,
            self.workflow.config,
            job.rule.name,
            None,
            str(script.parent),
        )
        return self.pool.submit(self._run_fork, pickle.dumps((str(script), snakemake)))

    def _run_fork(self, message: bytes) -> None:
        """Run a script in a fork of the server and wait for its end; SpawnedJobError where it fails."""
        link, theirs = socket.socketpair()
        with link:
            self.links.add(link)
            if self.cancelled:  # `cancel` may have looked at the links before this one was there
                self.links.remove(link)
                theirs.close()
                raise SpawnedJobError
            with theirs:
                socket.send_fds(self.control, [b"f"], [theirs.fileno()])
            link.sendall(len(message).to_bytes(8, "big") + message)
            code = link.recv(1)
            self.links.remove(link)
        if not code and not self.cancelled:
            self.logger.error("The job was killed, perhaps for want of memory")
        if code != b"\0":
            raise SpawnedJobError

    def shutdown(self) -> None:
        """Wait for all jobs, then end the server."""
        super().shutdown()
        self._stop_server()

    def cancel(self) -> None:
        """End all jobs and the server."""
        self.cancelled = True
        for link in list(self.links):
            link.shutdown(socket.SHUT_RDWR)
        super().cancel()
        self._stop_server()

    def _stop_server(self) -> None:
        """End the server where there is one."""
        if self.control is not None and self.server is not None:
            self.control.close()
            self.server.wait()
            self.control = self.server = None


def lift_rate_limit(scheduler: Any) -> None:
    """Let jobs start at any rate. With a limit each look for jobs starts a timer, and that starts another look."""
    scheduler.job_rate_limiter = None
    scheduler.resources["_job_count"] = sys.maxsize


def _script_path(rule: Any) -> Path | None:
    """Return the Python script of a rule on this machine; None where it has none."""
    if not rule.script or not str(rule.script).endswith(".py"):
        return None
    return Path(os.path.normpath(Path(str(rule.basedir)) / str(rule.script)))
