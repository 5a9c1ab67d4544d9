#!/usr/bin/env bash
# A cluster of one node, made for this test: the quick tier through Slurm, with the node and a job killed midway, gives
# the same datasets, bit for bit, as a local run.
#
#   tests/workflow/cluster.sh [LOCAL [TARGET...]]
#
# LOCAL    a clone of this commit in which the same targets were made at the quick tier; made in WORK if left out or -
# TARGET   of snakemake; all if left out
# WORK     (variable) folder for the clone that runs on the cluster, its log, and all of Slurm; a new one if not set
#
# Needs root, Debian's Slurm and munge, which are installed if missing, and two CPUs. All of Slurm, its key, sockets,
# state and logs, lies in WORK/slurm; other clusters on the machine are left alone. Compared are all files of COMPARED.
# Times, which differ from run to run, are in costs/ and figures/, and in trials.nc, of what was spent on trials.
set -euo pipefail
unset PYTHONDONTWRITEBYTECODE # jobs start faster where compiled code is kept
COMPARED='accuracy/*.nc trials/*.nc runs/*.nc datasets/*.nc decisions/*.json stability/*.nc effect_maps/*.nc claims/*.csv'
ROOT=$(cd "$(dirname "$0")/../.." && pwd)
COMMIT=$(git -C "$ROOT" rev-parse HEAD) # of both clones, whatever is committed meanwhile
LOCAL=${1:--}
shift || true
TARGETS=("${@:-all}")
WORK=${WORK:-$(mktemp -d)}
mkdir -p "$WORK"
WORK=$(cd "$WORK" && pwd)
CLUSTER=$WORK/cluster SLURM=$WORK/slurm
LOG=$WORK/snakemake.log
export SLURM_CONF=$SLURM/slurm.conf
COMMAND=(.venv/bin/snakemake --workflow-profile profiles/slurm "${TARGETS[@]}" --config tier=quick
  --slurm-groups-status-command squeue --slurm-groups-init-seconds-before-status-checks 5)

say() { printf '%(%H:%M:%S)T  %s\n' -1 "$*"; }

fail() {
  say "VERDICT: failed: $*"
  exit 1
}

clone_into() { # a clone of this commit with its packages
  if [ ! -d "$1" ]; then
    git clone --quiet "$ROOT" "$1"
    git -C "$1" checkout --quiet "$COMMIT"
  fi
  make --silent -C "$1" setup 2>"$WORK/setup.log" || fail "no set-up: see $WORK/setup.log"
}

configure() {
  mkdir -p "$SLURM"/{state,spool,bin} && chmod 700 "$SLURM"
  # the steps of a job are started without SLURM_CONF, as on a cluster, whose settings are in one place
  printf '#!/bin/sh\nSLURM_CONF=%q exec %q "$@"\n' "$SLURM_CONF" "$(command -v srun)" >"$SLURM/bin/srun"
  chmod +x "$SLURM/bin/srun"
  PATH=$SLURM/bin:$PATH
  [ -f "$SLURM/munge.key" ] || (umask 077 && head -c 1024 /dev/urandom >"$SLURM/munge.key")
  local megabytes=$(($(awk '/MemTotal/ {print $2}' /proc/meminfo) / 1024 - 2000))
  cat >"$SLURM_CONF" <<END
ClusterName=contactsim
SlurmctldHost=$(hostname)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$SLURM/munge.socket
StateSaveLocation=$SLURM/state
SlurmdSpoolDir=$SLURM/spool
SlurmctldPidFile=$SLURM/slurmctld.pid
SlurmdPidFile=$SLURM/slurmd.pid
SlurmctldLogFile=$SLURM/slurmctld.log
SlurmdLogFile=$SLURM/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SlurmdParameters=config_overrides
SlurmdTimeout=20
ReturnToService=2
MinJobAge=3600
NodeName=$(hostname) NodeAddr=127.0.0.1 CPUs=2 RealMemory=$megabytes
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE
END
}

start_cluster() {
  configure
  munged --force --key-file="$SLURM/munge.key" --socket="$SLURM/munge.socket" --pid-file="$SLURM/munged.pid" \
    --log-file="$SLURM/munged.log" --seed-file="$SLURM/munge.seed"
  slurmctld
  slurmd
  wait_for 60 node_is_up || fail "the node did not come up: see $SLURM"
  say "Slurm $(slurmctld -V | cut -d' ' -f2) is up: $(sinfo --noheader --format='%D node, %c CPUs, %m MB')"
}

node_is_up() { sinfo --noheader --format=%t | grep -qE '^(idle|mix|alloc)$'; }

wait_for() { # seconds, and what is to become true
  local end=$((SECONDS + $1))
  until "${@:2}"; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.2
  done
}

stop_cluster() {
  timeout 5 scancel --user=root 2>/dev/null || true
  for daemon in slurmd slurmctld munged; do
    [ ! -f "$SLURM/$daemon.pid" ] || kill "$(cat "$SLURM/$daemon.pid")" 2>/dev/null || true
  done
}

runs_done() { find "$CLUSTER/results/quick/runs" -name '*.done' 2>/dev/null | wc -l; }

runs_planned() { # as snakemake told before it began
  awk '$1 == "run" && NF == 2 {found = $2} END {print found + 0}' "$LOG"
}

may_be_killed() { # while a job runs, once a third of the runs is done; or the command has ended
  local ready
  ready=$(runs_done)
  { [ "$ready" -gt 0 ] && [ $((3 * ready)) -ge "$(runs_planned)" ] && [ -n "$(pids_of_jobs)" ]; } ||
    ! kill -0 "$SNAKEMAKE" 2>/dev/null
}

pids_of_jobs() { scontrol listpids 2>/dev/null | awk 'NR > 1 && $1 > 0 {print $1}'; }

lost_job_is_seen() { grep -q 'Error in group' "$LOG"; }

kill_midway() { # of a first command: the node's daemon, all processes of the running job, and the command itself
  local jobs
  say "first command: ${COMMAND[*]}"
  "${COMMAND[@]}" >"$LOG" 2>&1 &
  SNAKEMAKE=$!
  wait_for 1800 may_be_killed || fail "a third of the runs was not done in half an hour"
  kill -0 "$SNAKEMAKE" 2>/dev/null || fail "the first command ended before anything was killed: see $LOG"
  jobs=$(pids_of_jobs)
  say "$(runs_done) of $(runs_planned) runs done; jobs of Slurm: $(squeue --noheader --format=%T | sort | uniq -c | xargs)"
  kill -9 "$(cat "$SLURM/slurmd.pid")"
  kill -9 $jobs || true # some of them end with another
  say "killed with -9: slurmd, and the $(wc -w <<<"$jobs") processes of the running jobs"
  if wait_for 120 lost_job_is_seen; then
    say "seen by snakemake: $(grep -m1 -o 'Error in group.*' "$LOG")"
  else
    say "not seen by snakemake for two minutes"
  fi
  kill -9 "$SNAKEMAKE"
  wait "$SNAKEMAKE" 2>/dev/null || true
  say "killed with -9: snakemake; left in its queue, and cancelled: $(squeue --noheader | wc -l) jobs"
  scancel --user=root
  slurmd
  wait_for 60 node_is_up || fail "the node did not come back: see $SLURM"
  say "slurmd is back"
}

resume() {
  say "the same command again"
  "${COMMAND[@]}" >>"$LOG" 2>&1 || fail "the second command did not finish: see $LOG"
  say "finished: $(runs_done) runs done; $(find "$CLUSTER/results/quick" -name '.[0-9]*.*' | wc -l) temporary files left"
  "${COMMAND[@]}" --dry-run >"$WORK/dry-run.log" 2>&1 || fail "the dry run did not finish: see $WORK/dry-run.log"
  grep -q 'Nothing to be done' "$WORK/dry-run.log" || fail "there is still something to be done: see $WORK/dry-run.log"
  say "the same command once more: nothing to be done"
}

compare() { # files of both folders, in every way that COMPARED lists
  local pattern files same differ missing trouble=0
  for pattern in $COMPARED; do
    same=0 differ=0 missing=0
    while read -r files; do
      if [ ! -f "$LOCAL/results/quick/$files" ] || [ ! -f "$CLUSTER/results/quick/$files" ]; then
        missing=$((missing + 1)) && say "  only in one: $files"
      elif cmp --silent "$LOCAL/results/quick/$files" "$CLUSTER/results/quick/$files"; then
        same=$((same + 1))
      else
        differ=$((differ + 1)) && say "  differs: $files"
      fi
    done < <(list "$pattern" "$LOCAL" "$CLUSTER")
    say "$pattern: $same the same byte for byte, $differ differ, $missing missing"
    trouble=$((trouble + differ + missing))
  done
  return $((trouble > 0))
}

list() { # files below the first part of a pattern, of the ending of its second, in any of two folders
  for folder in "${@:2}"; do
    [ ! -d "$folder/results/quick/${1%%/*}" ] ||
      (cd "$folder/results/quick" && find "${1%%/*}" -name "${1#*/}" ! -name trials.nc)
  done | sort -u
}

[ "$(id -u)" = 0 ] || fail "needs root"
for program in slurmctld:slurm-wlm munged:munge; do
  command -v "${program%:*}" >/dev/null || DEBIAN_FRONTEND=noninteractive apt-get install -qq -y "${program#*:}"
done
say "commit ${COMMIT:0:7}, in $WORK"
clone_into "$CLUSTER"
trap stop_cluster EXIT
start_cluster
cd "$CLUSTER"
kill_midway
resume
if [ "$LOCAL" = - ]; then
  LOCAL=$WORK/local
  clone_into "$LOCAL"
  say "local run in $LOCAL"
  (cd "$LOCAL" && .venv/bin/snakemake --cores 2 "${TARGETS[@]}" --config tier=quick) >"$WORK/local.log" 2>&1 ||
    fail "the local run did not finish: see $WORK/local.log"
fi
compare || fail "the cluster's results are not those of the local run"
say "VERDICT: the same results, bit for bit"
