"""Scripts as forks of a server: they see, say and end as they would if they had been started anew."""

from __future__ import annotations

import os
import pickle
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest

from snakemake_executor_plugin_forkserver import Executor, SpawnedJobError
from support.places import ROOT

SERVER = ROOT / "src/snakemake_executor_plugin_forkserver/server.py"
PATIENCE = 60  # seconds until a test gives up


class Server:
    """A server and the socket that asks it for forks."""

    def __init__(self, script: Path) -> None:
        self.control, theirs = socket.socketpair()
        command = [sys.executable, "-P", str(SERVER), str(theirs.fileno()), str(script)]
        with theirs:
            self.process = subprocess.Popen(command, pass_fds=[theirs.fileno()], start_new_session=True)

    def start(self, script: Path, **values: object) -> socket.socket:
        """Start a fork that runs a script; return the link to it."""
        link, theirs = socket.socketpair()
        link.settimeout(PATIENCE)
        with theirs:
            socket.send_fds(self.control, [b"f"], [theirs.fileno()])
        job = SimpleNamespace(scriptdir=str(script.parent), **values)
        message = pickle.dumps((str(script), job))
        link.sendall(len(message).to_bytes(8, "big") + message)
        return link


@pytest.fixture
def script(tmp_path: Path) -> Path:
    """A script that writes what it knows of itself, and then does what it is told to."""
    path = tmp_path / "script.py"
    path.write_text(
        "import os, sys, time\n"
        "from colorsys import hsv_to_rgb\n"
        "from pathlib import Path\n"
        "Path(snakemake.output + '.part').write_text(f'{os.getpid()} {sys.argv[0]} {__name__}')\n"
        "os.replace(snakemake.output + '.part', snakemake.output)\n"
        "exec(snakemake.then)\n"
    )
    return path


@pytest.fixture
def server(script: Path) -> Iterator[Server]:
    """A server for the script."""
    server = Server(script)
    yield server
    server.control.close()
    assert server.process.wait(PATIENCE) == 0


def wait_for(path: Path) -> str:
    """Return the text of a file as soon as it is there."""
    end = time.monotonic() + PATIENCE
    while not path.exists():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)
    return path.read_text()


def wait_for_end(process: int) -> None:
    """Wait until a process is gone."""
    end = time.monotonic() + PATIENCE
    while Path(f"/proc/{process}").exists():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


@pytest.mark.parametrize(
    ("then", "code"),
    [
        ("pass", 0),
        ("sys.exit()", 0),
        ("sys.exit(3)", 3),
        ("sys.exit('in words')", 1),
        ("raise ValueError('made to fail')", 1),
        ("assert 'colorsys' in sys.modules", 0),
    ],
)
def test_a_script_runs_by_itself_and_its_exit_code_comes_back(
    server: Server, script: Path, tmp_path: Path, then: str, code: int
) -> None:
    with server.start(script, output=str(tmp_path / "output"), then=then) as link:
        assert link.recv(1) == bytes([code])
    process, name, module = (tmp_path / "output").read_text().split()
    assert int(process) not in (os.getpid(), server.process.pid)
    assert (name, module) == (str(script), "__main__")


def test_jobs_run_side_by_side_and_leave_no_trace_in_each_other(server: Server, script: Path, tmp_path: Path) -> None:
    first = server.start(script, output=str(tmp_path / "first"), then="os.environ['TRACE'] = 'x'; time.sleep(60)")
    wait_for(tmp_path / "first")
    with server.start(script, output=str(tmp_path / "second"), then="assert 'TRACE' not in os.environ") as second:
        assert second.recv(1) == b"\0"
    first.close()


def test_a_job_ends_with_the_other_end_of_its_link(server: Server, script: Path, tmp_path: Path) -> None:
    link = server.start(script, output=str(tmp_path / "output"), then="time.sleep(600)")
    process = int(wait_for(tmp_path / "output").split()[0])
    link.close()
    wait_for_end(process)


def test_a_job_that_is_killed_sends_no_code(server: Server, script: Path, tmp_path: Path) -> None:
    with server.start(script, output=str(tmp_path / "output"), then="os.kill(os.getpid(), 9)") as link:
        assert link.recv(1) == b""


def test_a_job_that_starts_while_all_are_stopped_is_not_run():
    executor = Executor.__new__(Executor)  # as it is after `cancel` has ended the jobs that it knew
    executor.cancelled, executor.links, executor.control = True, set(), None
    with pytest.raises(SpawnedJobError):
        executor._run_fork(b"")
    assert executor.links == set()
