"""A process that has everything imported and stands by: each job is a fork of it, and starts in no time.

Importing numpy, scipy, xarray and matplotlib costs a job more than solving most scenes. The workflow therefore starts
its scripts by `python standby.py SOCKET SCRIPT`: this file is then a messenger that imports almost nothing. It hands
files, folder and environment to the process that stands by, waits for the fork's exit code, and where nobody stands by,
or a job has more than one thread, starts an ordinary Python. A messenger that is killed takes its job with it; the
process that stands by ends with the one that started it.
"""

from __future__ import annotations

import os
import socket
import sys

WORD = 8
"""Bytes of the length that precedes a message."""


def main(arguments: list[str]) -> None:
    """Run `SCRIPT ...` in the process that stands by at the socket; start it anew where there is none."""
    place, command = arguments[0], arguments[1:]
    if os.environ.get("OMP_NUM_THREADS") == "1" and os.path.isfile(command[0]):
        with socket.socket(socket.AF_UNIX) as link:
            try:
                link.connect(place)
            except OSError:
                pass
            else:
                sys.exit(_hand_over(link, command))
    os.execv(sys.executable, [sys.executable, *command])


def _hand_over(link: socket.socket, command: list[str]) -> int:
    """Exit code of a command run by a fork, with this process's files, folder and environment."""
    told = b"\0".join(os.fsencode(part) for part in [os.getcwd(), str(len(command)), *command])
    told += b"".join(b"\0" + os.fsencode(f"{key}={value}") for key, value in os.environ.items())
    socket.send_fds(link, [len(told).to_bytes(WORD, "big")], [0, 1, 2])
    link.sendall(told)
    code = link.recv(1)
    return code[0] if code else 1  # none: the fork was killed


def serve(place: str, scripts: str) -> None:
    """Stand by at a socket, with all that the scripts of a folder import, until the standard input ends."""
    import gc
    import select
    import signal

    temporary = f"{place}.{os.getpid()}"
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(temporary)
    listener.listen(64)
    os.replace(temporary, place)
    _import_all(scripts)
    gc.freeze()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody here waits for a fork
    while sys.stdin not in select.select([listener, sys.stdin], [], [])[0]:
        link = listener.accept()[0]
        if os.fork() == 0:
            listener.close()
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            _work(link)
        link.close()
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
                importlib.import_module(node.module)


def _work(link: socket.socket) -> None:
    """Be the job that a messenger asks for; never returns."""
    import runpy
    import threading
    import traceback

    code = 1
    try:
        length, files, _, _ = socket.recv_fds(link, WORD, 3)
        told = b""
        while len(told) < int.from_bytes(length, "big"):
            told += link.recv(2**20)
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
        sys.stdout.flush()
        sys.stderr.flush()
        link.sendall(bytes([code]))
        os._exit(code)


def _die_with(link: socket.socket) -> None:
    """End this process when the messenger does."""
    link.recv(1)
    os._exit(1)


if __name__ == "__main__":
    if sys.argv[1] == "--serve":
        serve(*sys.argv[2:])
    else:
        main(sys.argv[1:])
