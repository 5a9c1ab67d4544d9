"""Jobs as forks of a process that stands by: they see, say and end as they would if they had been started anew."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from contactsim import standby

PATIENCE = 60  # seconds until a test gives up


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[subprocess.Popen, Path]]:
    """A process that stands by for scripts that import one module of this package, and its socket."""
    folder = tmp_path_factory.mktemp("standby")
    (folder / "script.py").write_text(
        "import numpy\nfrom contactsim.errors import SceneError\nfrom numpy import linalg\n"
    )
    place = folder / "socket"
    server, _ = standby.start(sys.executable, str(place), str(folder))
    _until(place.exists)
    yield server, place
    server.stdin.close()
    assert server.wait(PATIENCE) == 0
    assert not place.exists()


def _until(reached: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not reached():
        assert time.monotonic() < end
        time.sleep(0.02)


def _started(
    place: Path, tmp_path: Path, script: str, *words: str, threads: str = "1", more: Mapping[str, str] | None = None
) -> subprocess.Popen:
    (tmp_path / "job.py").write_text(script)
    command = [sys.executable, "-I", "-S", standby.__file__, str(place), str(tmp_path / "job.py"), *words]
    environment = os.environ | {"OMP_NUM_THREADS": threads, "NOTE": "a note\nof two lines"} | (more or {})
    pipe = subprocess.PIPE
    return subprocess.Popen(command, cwd=tmp_path, env=environment, stdout=pipe, stderr=pipe, text=True)


def _gone(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    return False


SEEN = """
import os, sys
print(sys.argv[1:], os.getcwd(), os.environ["NOTE"], __name__, "contactsim.errors" in sys.modules)
print("beside", file=sys.stderr)
"""


def test_a_job_has_its_messengers_files_folder_words_and_environment(standing, tmp_path):
    out, err = (job := _started(standing[1], tmp_path, SEEN, "a", "b c")).communicate(timeout=PATIENCE)
    assert job.returncode == 0
    assert out == f"['a', 'b c'] {tmp_path} a note\nof two lines __main__ True\n"
    assert err == "beside\n"


@pytest.mark.parametrize(("threads", "nobody"), [("2", False), ("1", True)])
def test_where_nobody_stands_by_or_threads_are_several_a_job_starts_anew(standing, tmp_path, threads, nobody):
    place = tmp_path / "nobody" if nobody else standing[1]
    out, err = (job := _started(place, tmp_path, SEEN, "a", threads=threads)).communicate(timeout=PATIENCE)
    assert job.returncode == 0
    assert out == f"['a'] {tmp_path} a note\nof two lines __main__ False\n"
    assert err == "beside\n"


@pytest.mark.parametrize(
    ("script", "code", "told"),
    [
        ("raise SystemExit(3)", 3, ""),
        ("raise SystemExit", 0, ""),
        ("raise SystemExit('refused')", 1, "refused\n"),
        ("1 / 0", 1, "ZeroDivisionError"),
        ("raise SystemExit(259)", 3, ""),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", 137, "killed"),
    ],
)
def test_a_job_ends_as_its_script_does(standing, tmp_path, script, code, told):
    _, err = (job := _started(standing[1], tmp_path, script)).communicate(timeout=PATIENCE)
    assert job.returncode == code
    assert told in err


PRODUCT = """
import hashlib
import numpy as np
a = np.random.default_rng(1).normal(size=(600, 600))
print(hashlib.sha256(a @ a).hexdigest(), float(np.vdot(a, a)).hex(), float(a.ravel() @ a.ravel()).hex())
"""


def test_a_fork_counts_as_a_process_of_its_own_does_to_the_last_bit(standing, tmp_path):
    found = []
    for place in (standing[1], tmp_path / "nobody"):
        job = _started(place, tmp_path, PRODUCT, more=standby.ONE_THREAD)
        found.append(job.communicate(timeout=PATIENCE)[0])
        assert job.returncode == 0
    assert found[0] == found[1]


def test_a_module_of_the_package_hides_no_other_package(standing, tmp_path):
    job = _started(standing[1], tmp_path, "import tabulate; print(tabulate.__version__)")
    assert job.communicate(timeout=PATIENCE)[0]


@pytest.mark.parametrize("said", [b"", (10**6).to_bytes(8, "big"), (10**6).to_bytes(8, "big") + b"part"])
def test_a_fork_whose_messenger_goes_before_it_said_all_goes_too(standing, said):
    _until(lambda: not _forks(standing[0].pid))  # those of other tests are gone
    with socket.socket(socket.AF_UNIX) as link:
        link.connect(str(standing[1]))
        assert link.recv(1) == standby.READY
        assert len(_forks(standing[0].pid)) == 1
        link.sendall(said)
    _until(lambda: not _forks(standing[0].pid))


def _forks(process: int) -> list[str]:
    return Path(f"/proc/{process}/task/{process}/children").read_text().split()


def test_a_job_starts_by_itself_where_the_process_that_stood_by_has_ended(tmp_path):
    place = tmp_path / "socket"
    with socket.socket(socket.AF_UNIX) as listener:  # somebody listens, but goes before there is a fork
        listener.bind(str(place))
        listener.listen()
        job = _started(place, tmp_path, SEEN)
        listener.accept()[0].close()
    assert job.communicate(timeout=PATIENCE)[0]
    assert job.returncode == 0


def test_a_script_may_start_processes_and_wait_for_them(standing, tmp_path):
    script = "import subprocess, sys; print(subprocess.run([sys.executable, '-c', 'exit(5)']).returncode)"
    out, _ = _started(standing[1], tmp_path, script).communicate(timeout=PATIENCE)
    assert out == "5\n"


def test_a_job_ends_when_its_messenger_is_killed(standing, tmp_path):
    script = "import os, time; open('pid', 'w').write(str(os.getpid())); time.sleep(600)"
    messenger = _started(standing[1], tmp_path, script)
    _until(lambda: (tmp_path / "pid").exists() and (tmp_path / "pid").read_text())
    job = int((tmp_path / "pid").read_text())
    assert os.getpgid(job) == os.getpgid(standing[0].pid), "the job must be a fork"
    messenger.send_signal(signal.SIGKILL)
    messenger.communicate()
    _until(lambda: _gone(job))


def test_jobs_run_beside_each_other(standing, tmp_path):
    for name in "ab":
        (tmp_path / name).mkdir()
    wait = "import os, time\nwhile not os.path.exists('../go'): time.sleep(0.01)\nprint('went')"
    first = _started(standing[1], tmp_path / "a", wait)
    second = _started(standing[1], tmp_path / "b", "open('../go', 'w').close()")
    assert second.wait(PATIENCE) == 0
    assert first.communicate(timeout=PATIENCE)[0] == "went\n"
    second.communicate()
