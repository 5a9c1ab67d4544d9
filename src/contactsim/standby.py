"""A process that has everything imported and stands by: each job is a fork of it, and starts in no time.

Importing numpy, scipy, xarray and matplotlib costs a job more than solving most scenes. The workflow therefore starts
its scripts by `python standby.py SOCKET SCRIPT`: this file is then a messenger that imports almost nothing. It hands
files, folder and environment to the process that stands by, waits for the fork's exit code, and where nobody stands by,
or a job has more than one thread, starts an ordinary Python. A messenger that is killed takes its job with it; the
process that stands by ends with the one that started it.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
from contextlib import suppress

WORD, READY, KILLED = 8, b"+", 137
"""Bytes of the length that precedes a message; what a fork says first; the code of a job that said nothing at last."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment in which libraries of linear algebra count on one thread; they read it when they are imported."""


def main(arguments: list[str]) -> None:
    """Run `SCRIPT ...` in the process that stands by at the socket; in an ordinary Python where there is none."""
    place, command = arguments[0], arguments[1:]
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if os.environ.get("OMP_NUM_THREADS") == "1" and os.path.isfile(command[0]):
        with socket.socket(socket.AF_UNIX) as link:
            if _forked(link, place):
                sys.exit(_hand_over(link, command))
    os.execv(sys.executable, [sys.executable, *command])


def _forked(link: socket.socket, place: str) -> bool:
    """Whether there is a fork at the other end, which says so."""
    try:
        link.connect(place)
        return link.recv(1) == READY
    except OSError:
        return False


def _hand_over(link: socket.socket, command: list[str]) -> int:
    """Exit code of a command run by a fork, with this process's files, folder and environment."""
    told = b"\0".join(os.fsencode(part) for part in [os.getcwd(), str(len(command)), *command])
    told += b"".join(b"\0" + os.fsencode(f"{key}={value}") for key, value in os.environ.items())
    socket.send_fds(link, [len(told).to_bytes(WORD, "big")], [0, 1, 2])
    link.sendall(told)
    code = link.recv(1)
    if code:
        return code[0]
    print("The job was killed, perhaps for want of memory", file=sys.stderr)
    return KILLED


def start(python: str, place: str, scripts: str) -> tuple[object, list[str]]:
    """Start a process that stands by for the scripts of a folder; that process, and how a job is started now.

    It counts on one thread, as its jobs do, and ends when this process does, whose end of a pipe then closes.
    """
    from subprocess import PIPE, Popen

    command = [python, "-P", __file__, "--serve", place, scripts]
    process = Popen(command, stdin=PIPE, start_new_session=True, env=os.environ | ONE_THREAD)
    return process, [python, "-I", "-S", __file__, place]


def serve(place: str, scripts: str) -> None:
    """Stand by at a socket, with all that the scripts of a folder import, until the standard input ends."""
    import gc
    import select

    temporary = f"{place}.{os.getpid()}"
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(temporary)
    listener.listen(64)
    os.replace(temporary, place)
    _import_all(scripts)
    gc.freeze()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody here waits for a fork
    try:
        while sys.stdin not in select.select([listener, sys.stdin], [], [])[0]:
            with listener.accept()[0] as link, suppress(OSError):  # without a fork the job starts by itself
                if os.fork() == 0:
                    listener.close()
                    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
                    _work(link)
    finally:
        os.unlink(place)


def _import_all(scripts: str) -> None:
    """Import what the scripts of a folder do from this package, and what snakemake puts before them."""
    import ast
    import importlib
    from pathlib import Path

    importlib.import_module("snakemake.script")
    for script in sorted(Path(scripts).glob("*.py")):
        for node in ast.walk(ast.parse(script.read_text())):
            if isinstance(node, ast.ImportFrom):
                for name in (node.module, *(f"{node.module}.{alias.name}" for alias in node.names)):
                    with suppress(ImportError):  # a name within a module; or what the script itself will stumble over
                        importlib.import_module(name)


def _work(link: socket.socket) -> None:
    """Be the job that a messenger asks for; never returns."""
    import runpy
    import threading
    import traceback

    code = 1
    try:
        link.sendall(READY)
        length, files, _, _ = socket.recv_fds(link, WORD, 3)
        told = b"" if len(length) == WORD else _leave()
        while len(told) < int.from_bytes(length, "big"):
            told += link.recv(2**20) or _leave()
        for number, file in enumerate(files):
            os.dup2(file, number)
            os.close(file)
        folder, count, *rest = told.split(b"\0")
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(os.fsdecode(pair).split("=", 1) for pair in rest[int(count) :])
        sys.argv = [os.fsdecode(part) for part in rest[: int(count)]]
        threading.Thread(target=_die_with, args=[link], daemon=True).start()
        runpy.run_path(sys.argv[0], run_name="__main__")
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
    except BaseException:
        traceback.print_exc()
    finally:
        with suppress(OSError):
            sys.stdout.flush()
            sys.stderr.flush()
            link.sendall(bytes([code & 255]))
        os._exit(code & 255)


def _leave() -> bytes:
    """End this process, whose messenger is gone before it said all."""
    os._exit(1)


def _die_with(link: socket.socket) -> None:
    """End this process when the messenger does."""
    link.recv(1)
    os._exit(1)


if __name__ == "__main__":
    if sys.argv[1] == "--serve":
        serve(*sys.argv[2:])
    else:
        main(sys.argv[1:])
