"""One line tells how far the workflow has come and how long it will take; errors and the end are told once."""

from __future__ import annotations

import io
import logging
import signal
from types import SimpleNamespace

import pytest
from snakemake_interface_logger_plugins.common import LogEvent

from snakemake_logger_plugin_progress import LogHandler, LogHandlerSettings
from snakemake_logger_plugin_progress.progress import Job, Progress
from support.project import Project, wait_for


def progress_of(*predictions, cores=1):
    jobs = {number: Job(number, "run", predicted=seconds) for number, seconds in enumerate(predictions)}
    return Progress(cores=cores, waiting=jobs)


def run_job(progress, number, seconds, start=0.0):
    progress.start(progress.waiting[number], start)
    progress.finish(number, start + seconds)


def test_before_anything_has_ended_the_predictions_hold():
    progress = progress_of(10.0, 20.0, 30.0, cores=2)
    assert progress.seconds_left(0.0) == 30.0  # the longest; all together 60 on two cores
    progress.start(progress.waiting[2], 0.0)
    assert progress.share(15.0) == pytest.approx(15 / 60)
    assert progress.seconds_left(15.0) == pytest.approx((15 + 30) / 2)


def test_jobs_that_take_longer_than_predicted_lengthen_the_rest():
    progress = progress_of(100.0, 100.0)
    run_job(progress, 0, 300.0)
    assert progress.seconds_left(300.0) == pytest.approx(300.0, rel=0.05)
    assert progress.share(300.0) == pytest.approx(0.5)


def test_a_job_without_prediction_takes_as_long_as_others_of_its_rule():
    progress = Progress(waiting={number: Job(number, "survey") for number in range(3)})
    run_job(progress, 0, 8.0)
    assert progress.seconds_left(8.0) == pytest.approx(16.0)


def test_at_the_end_all_is_over_whatever_failed():
    progress = progress_of(1.0, 1.0)
    run_job(progress, 0, 2.0)
    progress.start(progress.waiting[1], 2.0)
    progress.fail(1)
    assert progress.share(3.0) == pytest.approx(1.0)
    assert progress.seconds_left(3.0) == 0.0
    assert (progress.total, len(progress.failed)) == (2, 1)


@pytest.fixture
def project(tmp_path):
    return Project.new(tmp_path / "project")


@pytest.fixture
def handler(monkeypatch):
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    made = LogHandler(SimpleNamespace(stdout=False, dryrun=False), LogHandlerSettings())
    made.setFormatter(logging.Formatter())
    return made


def tell(handler, text="", level=logging.INFO, **facts):
    handler.emit(logging.makeLogRecord({"msg": text, "levelno": level, **facts}))
    return handler.stream.getvalue()


def job(number, output=()):
    facts = {"jobid": number, "rule_name": "figure", "rule_msg": f"figure {number}", "output": output}
    return {"event": LogEvent.JOB_INFO, **facts}


def test_what_tells_a_user_nothing_is_not_shown(handler):
    assert tell(handler, "Building DAG of jobs...") == ""
    assert tell(handler, "many lines", event=LogEvent.RUN_INFO) == ""
    assert tell(handler, "Nothing to be done").endswith("Nothing to be done\n")
    assert tell(handler, "Building DAG of jobs: beware", level=logging.WARNING).endswith("beware\n")


def test_the_end_names_what_was_made_and_the_log(handler):
    tell(handler, **job(1, ["results/a.png", "results/a.csv"]))
    tell(handler, event=LogEvent.JOB_FINISHED, job_id=1)
    tell(handler, "Complete log(s): /somewhere/else.log")
    handler.close()
    lines = handler.stream.getvalue().splitlines()
    assert lines[0] == "100 %, 1 of 1 jobs, done: figure 1"
    assert lines[1:] == ["1 of 1 jobs done in 0 s.", "Made: results/a.png", "Log: /somewhere/else.log"]


def test_an_error_is_shown_but_not_that_of_a_job_that_the_user_stopped(handler):
    tell(handler, **job(1))
    assert "it broke" in tell(handler, "it broke", logging.ERROR, event=LogEvent.JOB_ERROR, jobid=1)
    tell(handler, "Terminating processes on user request, this might take some time.")
    tell(handler, **job(2))
    shown = tell(handler, "it was killed", logging.ERROR, event=LogEvent.JOB_ERROR, jobid=2)
    assert "it was killed" not in shown
    handler.close()
    assert "the same command goes on" in handler.stream.getvalue()


def test_a_figure_takes_a_few_lines_where_the_output_is_no_terminal(project):
    done = project.snakemake("--", "fig_9_1")
    assert done.returncode == 0
    lines = [line for line in done.stderr.splitlines() if not line.startswith("Using ")]
    assert lines[0].startswith("Predicted for 1 runs and 2 other jobs")
    assert lines[-3].startswith("3 of 3 jobs done in")
    assert lines[-2] == "Made: results/standard/figures/fig_9_1.png"
    assert lines[-1].startswith("Log: .snakemake/log/")
    assert "fig_9_1: results" in (project.folder / lines[-1].removeprefix("Log: ")).read_text(encoding="utf-8")
    assert 5 <= len(lines) <= 7
    assert all(" of 3 jobs" in line for line in lines[1:-2])


def test_a_workflow_that_is_stopped_says_that_it_goes_on_and_does(project, tmp_path):
    log = tmp_path / "log"
    with log.open("w") as file, project.paused("step 2/3", "--", "smooth", stderr=file) as stopped:
        stopped.process.send_signal(signal.SIGINT)
        wait_for(lambda: stopped.process.poll() is not None)
    text = log.read_text(encoding="utf-8")
    assert "Stopped: 0 of" in text
    assert "the same command goes on" in text
    assert "Error" not in text
    assert project.make("smooth")
