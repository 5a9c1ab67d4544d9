"""The Slurm executor of Snakemake, which passes the sizes of groups on to the Slurm jobs that it submits.

Without them the Snakemake within a Slurm job splits its group and starts its jobs one after the other, each by itself.
"""

from __future__ import annotations

from dataclasses import replace

from snakemake_executor_plugin_slurm import Executor, ExecutorSettings
from snakemake_executor_plugin_slurm import common_settings as slurm_settings

__all__ = ["Executor", "ExecutorSettings", "common_settings"]

common_settings = replace(slurm_settings, pass_group_args=True)
