"""A Snakemake logger that shows one line on how far the workflow has come, and what there is at the end.

In a terminal the line is renewed every second. Elsewhere a line is printed now and then. Errors and warnings are shown
as Snakemake writes them, and its whole log is in the file that the last line names. `--logger-progress-full` shows all
of Snakemake's own lines instead.
"""

import os
import shutil
import sys
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from logging import WARNING, LogRecord
from pathlib import Path
from typing import Any, TextIO

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.settings import LogHandlerSettingsBase

from contactsim.durations import duration_text
from snakemake_logger_plugin_progress.progress import Job, Progress

__all__ = ["LogHandler", "LogHandlerSettings", "predict"]

PERIOD = 1.0
"""Seconds between two renewals of the line in a terminal."""
PLAIN_SHARE, PLAIN_SECONDS = 0.05, 60.0
"""Share of the work, or seconds, between two lines where the output is no terminal."""
UNSEEN = (
    "Assuming unrestricted shared filesystem",
    "Building DAG of jobs",
    "Elapsed time:",
    "Group jobs: inactive",
    "Select jobs to execute",
    "Using shell:",
    "Will exit after finishing currently running jobs",
)
"""Starts of messages that tell a user of a figure nothing."""
LOG = "Complete log(s):"
INTERRUPTED = "Terminating processes on user request"
UNSEEN_EVENTS = {LogEvent.RUN_INFO, LogEvent.RESOURCES_INFO, LogEvent.SHELLCMD, LogEvent.WORKFLOW_STARTED}
SHOWN_ENDINGS = (".png", ".html", ".gif")
"""Endings of files that a user looks at."""
MAX_SHOWN_FILES = 3

_PREDICTIONS: dict[int, tuple[str, float | None]] = {}


def predict(jobs: Mapping[int, tuple[str, float | None]]) -> None:
    """Tell the logger of all jobs of the workflow before they start: number, rule and CPU seconds, if predicted."""
    _PREDICTIONS.update(jobs)


@dataclass
class LogHandlerSettings(LogHandlerSettingsBase):
    """Options on the command line."""

    full: bool = field(default=False, metadata={"help": "Show all of Snakemake's own lines", "required": False})


class LogHandler(LogHandlerBase):  # type: ignore[misc]  # Snakemake is not typed
    """Write the line of progress, errors, and a summary at the end."""

    settings: LogHandlerSettings

    def __post_init__(self) -> None:
        self.stream: TextIO = sys.stdout if self.common_settings.stdout else sys.stderr
        self.full = self.settings.full or self.common_settings.dryrun
        self.live = self.stream.isatty() and not self.full
        self.progress, self.files = Progress(), list[str]()
        self.outputs: dict[int, list[str]] = {}
        self.start, self.last_share, self.last_time = time.monotonic(), 0.0, time.monotonic()
        self.log_file, self.interrupted, self.ended = "", False, threading.Event()
        if self.live:
            self._write_line("reading the settings")
            threading.Thread(target=self._renew, daemon=True).start()

    @property
    def writes_to_stream(self) -> bool:
        """True, so Snakemake writes nothing to the stream itself."""
        return True

    @property
    def writes_to_file(self) -> bool:
        """False: Snakemake's own file is kept."""
        return False

    @property
    def has_filter(self) -> bool:
        """False: Snakemake's filter is used."""
        return False

    @property
    def has_formatter(self) -> bool:
        """False: Snakemake's formatter is used for what is shown as it is."""
        return False

    @property
    def needs_rulegraph(self) -> bool:
        """False."""
        return False

    def emit(self, record: LogRecord) -> None:
        """Take in a record, and show it if it is something to read."""
        if self.full:
            self._write(self.format(record))
            return
        note = self.NOTES.get(getattr(record, "event", None))
        if note is not None:
            note(self, record)
        elif getattr(record, "event", None) not in UNSEEN_EVENTS:
            self._show(record)

    def _show(self, record: LogRecord) -> None:
        """Show a message, or keep what the summary needs of it."""
        text = self.format(record).strip()
        if text.startswith(LOG):
            self.log_file = text.removeprefix(LOG).strip()
        elif text.startswith(INTERRUPTED):
            self.interrupted = True
        elif text and not self.interrupted and (record.levelno >= WARNING or not text.startswith(UNSEEN)):
            self._write(text)

    def _note_run(self, record: LogRecord) -> None:
        """Take in the number of cores."""
        self.progress.cores = getattr(record, "cores", None) or self.progress.cores

    def _note_job(self, record: LogRecord) -> None:
        """Take in a job that starts."""
        if not self.progress.total:
            jobs = {number: Job(number, rule, predicted=seconds) for number, (rule, seconds) in _PREDICTIONS.items()}
            self.progress.waiting |= jobs
        facts: Any = record
        known = self.progress.waiting.get(facts.jobid)
        label = (facts.rule_msg or facts.rule_name).strip()
        job = Job(facts.jobid, facts.rule_name, label, known.predicted if known else None)
        self.outputs[job.number] = list(facts.output)
        self.progress.start(job, time.monotonic())

    def _note_end(self, record: LogRecord) -> None:
        """Take in a job that has ended."""
        facts: Any = record
        job = self.progress.finish(facts.job_id, time.monotonic())
        if job is not None:
            self.files += [file for file in self.outputs.pop(job.number, []) if file.endswith(SHOWN_ENDINGS)]
            self._tell_plainly(job)

    def _note_failure(self, record: LogRecord) -> None:
        """Take in a job that has failed, and show what Snakemake says of it."""
        facts: Any = record
        self.progress.fail(facts.jobid)
        if not self.interrupted:
            self._write(self.format(record))

    def _tell_plainly(self, job: Job) -> None:
        """Print a line where the output is no terminal, if enough was done since the last."""
        now, share = time.monotonic(), self.progress.share(time.monotonic())
        if not self.live and (share >= self.last_share + PLAIN_SHARE or now >= self.last_time + PLAIN_SECONDS):
            self.last_share, self.last_time = share, now
            self._write(f"{self._counts(now)}, done: {job.label or job.rule}")

    def _counts(self, now: float) -> str:
        """Return how much is done, and the time left."""
        progress, share = self.progress, self.progress.share(now)
        text = f"{100 * share:3.0f} %, {len(progress.done)} of {progress.total} jobs"
        if progress.waiting or progress.running:
            text += f", about {duration_text(round(progress.seconds_left(now)))} left"
        return text

    def _renew(self) -> None:
        """Renew the line until the workflow ends."""
        while not self.ended.wait(PERIOD):
            with self.lock:
                self._write_line(self._line())

    def _line(self) -> str:
        """Return the line of progress."""
        if not self.progress.total:
            return "reading the settings"
        jobs = [job.label or job.rule for job, _ in self.progress.running.values()]
        return self._counts(time.monotonic()) + "".join(f" · {label}" for label in jobs)

    def _write_line(self, text: str) -> None:
        """Write the line that is renewed, cut to the width of the terminal."""
        width = shutil.get_terminal_size().columns
        self.stream.write(f"\r\x1b[2K{text[: width - 1]}")
        self.stream.flush()

    def _write(self, text: str) -> None:
        """Write a text that stays, above the line of progress."""
        self.stream.write(("\r\x1b[2K" if self.live else "") + text + "\n")
        if self.live:
            self._write_line(self._line())
        self.stream.flush()

    def close(self) -> None:
        """Write the summary."""
        if not self.ended.is_set():
            self.ended.set()
            if self.live:
                self.stream.write("\r\x1b[2K")
            if self.progress.total and not self.full:
                self.stream.write("\n".join(self._summary()) + "\n")
            self.stream.flush()
        super().close()

    def _summary(self) -> list[str]:
        """Return the lines at the end: what was done, what was made, and where the log is."""
        progress = self.progress
        elapsed = duration_text(round(time.monotonic() - self.start))
        text = f"{len(progress.done)} of {progress.total} jobs done in {elapsed}"
        if self.interrupted:
            text = f"Stopped: {text}. What is made is kept; the same command goes on"
        elif progress.failed:
            text += f", {len(progress.failed)} failed. What is made is kept"
        lines = [text + "."]
        if self.files:
            more = len(self.files) - MAX_SHOWN_FILES
            folder = f" and {more} more in {os.path.commonpath(self.files)}" if more > 0 else ""
            lines.append(f"Made: {', '.join(self.files[-MAX_SHOWN_FILES:])}{folder}")
        if self.log_file:
            lines.append(f"Log: {_short(self.log_file)}")
        return lines

    NOTES = {
        LogEvent.RESOURCES_INFO: _note_run,
        LogEvent.JOB_INFO: _note_job,
        LogEvent.JOB_FINISHED: _note_end,
        LogEvent.JOB_ERROR: _note_failure,
        LogEvent.JOB_STARTED: lambda self, record: None,
        LogEvent.PROGRESS: lambda self, record: None,
    }


def _short(path: str) -> str:
    """Return a path from the working folder where it lies in it."""
    try:
        return str(Path(path).relative_to(Path.cwd()))
    except ValueError:
        return path
