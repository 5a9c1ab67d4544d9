"""The process of which jobs are forks; it imports what the scripts do and ends when Snakemake does.

Snakemake sends it one end of a pair of sockets for each job. The fork reads from it a script's path and the
`snakemake` object, runs the script, and answers with the exit code. A fork ends when the other end of its socket does.
"""

from __future__ import annotations

import ast
import gc
import importlib
import os
import pickle
import runpy
import signal
import socket
import sys
import threading
import traceback
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import NoReturn


def serve(control: socket.socket, scripts: Iterable[str]) -> None:
    """Import what scripts need, then make a fork for each socket that comes, until Snakemake closes its end."""
    import_all(scripts)
    gc.freeze()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody here waits for a fork
    while True:
        message, (*files,), _, _ = socket.recv_fds(control, 1, 1)
        if not message:
            return
        with socket.socket(fileno=files[0]) as link:
            if os.fork() == 0:
                control.close()
                signal.signal(signal.SIGCHLD, signal.SIG_DFL)
                run_job(link)


def import_all(scripts: Iterable[str]) -> None:
    """Import the modules that scripts import; what cannot be imported fails in the script, with its message."""
    for name in ("snakemake.iocontainers", "snakemake.io"):  # what the `snakemake` object is made of
        importlib.import_module(name)
    for script in scripts:
        for node in ast.walk(ast.parse(Path(script).read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                for name in (node.module, *(f"{node.module}.{alias.name}" for alias in node.names)):
                    with suppress(ImportError):
                        importlib.import_module(str(name))


def run_job(link: socket.socket) -> NoReturn:
    """Run the script that a socket names, and answer with its exit code."""
    code = 1
    try:
        length = int.from_bytes(link.recv(8, socket.MSG_WAITALL), "big")
        script, snakemake = pickle.loads(link.recv(length, socket.MSG_WAITALL))
        threading.Thread(target=end_with, args=[link], daemon=True).start()
        sys.argv = [script]
        sys.path.append(snakemake.scriptdir)
        runpy.run_path(script, {"snakemake": snakemake}, "__main__")
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


def end_with(link: socket.socket) -> NoReturn:
    """End this process when the other end of a socket is closed."""
    link.recv(1)
    os._exit(1)


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])), sys.argv[2:])
