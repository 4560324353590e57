#!/usr/bin/env bash
# tools/slurm_test.sh [PROGRAM]: starts Slurm on this machine (one node, no systemd), runs a sweep on it as an array of eight
# shards, requeues one of them while it runs, and compares the table with that of a local run. Needs root and Debian's
# packages slurm-wlm and munge, which it installs; everything it starts and writes is gone when it ends.
set -euo pipefail
cd "$(dirname "$0")/.."
program=$(realpath "${1:-build/release/wunderlich}")
[ "$(id -u)" -eq 0 ] || { echo "slurm_test: needs root, to start munge and Slurm" >&2; exit 2; }
if ! command -v slurmctld >/dev/null || ! command -v munged >/dev/null; then
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge >/dev/null
fi

place=$(mktemp -d)
chmod 755 "$place"
node=$(hostname -s)
processes=()
clean_up() {
  scancel --user=root 2>/dev/null || true
  for process in "${processes[@]}"; do kill "$process" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$place"
}
trap clean_up EXIT

# munge authenticates what the daemons say to each other; its key and socket live here, not in the system's folders.
dd if=/dev/urandom of="$place/munge.key" bs=1024 count=1 status=none
chmod 400 "$place/munge.key"
munged --foreground --force --key-file="$place/munge.key" --socket="$place/munge.socket" --log-file="$place/munged.log" \
  --pid-file="$place/munged.pid" --seed-file="$place/munge.seed" --num-threads=2 &
processes+=($!)

mkdir -p "$place/state" "$place/spool"
cat >"$place/slurm.conf" <<CONF
ClusterName=here
SlurmctldHost=$node(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$place/munge.socket
CryptoType=crypto/munge
SlurmctldPort=26817
SlurmdPort=26818
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool
SlurmctldPidFile=$place/slurmctld.pid
SlurmdPidFile=$place/slurmd.pid
SlurmctldLogFile=$place/slurmctld.log
SlurmdLogFile=$place/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,requeue_delay=0
JobRequeue=1
MinJobAge=300
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=short Nodes=$node Default=YES MaxTime=60 State=UP
CONF
export SLURM_CONF=$place/slurm.conf
for _ in $(seq 50); do [ -S "$place/munge.socket" ] && break; sleep 0.1; done
slurmctld -D -c >"$place/slurmctld.out" 2>&1 &
processes+=($!)
slurmd -D >"$place/slurmd.out" 2>&1 &
processes+=($!)
for _ in $(seq 100); do sinfo --noheader --format=%T 2>/dev/null | grep -qE '^(idle|mixed|allocated)' && break; sleep 0.3; done
sinfo --noheader --format=%T | grep -qE '^(idle|mixed|allocated)' || {
  echo "slurm_test: the node did not come up" >&2
  tail -n 20 "$place"/*.log "$place"/*.out >&2
  exit 1
}

# Runs of some 30 ms, so that a shard can be caught at work.
cat >"$place/sweep.yaml" <<'YAML'
scene: moebius
set: {ribbon.segments: 400}
axes:
  - {name: aspect, key: ribbon.aspect, linear: {from: 8, to: 20, count: 20}}
  - {name: stiffness, key: ribbon.bending_stiffness, log: {from: 0.1, to: 10, count: 20}}
collect: {energy: energy.normalized, ruling_ratio: constraints.max_ruling_ratio, seconds: timing.wall_seconds}
YAML
without_timing() { cut -d, -f1-8 "$1"; }  # run, key, axes, status, reason, results; the clock's columns come last

"$program" sweep "$place/sweep.yaml" --out "$place/local" --quiet
"$program" sweep "$place/sweep.yaml" --out "$place/there" --engine slurm --shards 8 --walltime 0:30:00 --partition short
job=$(cat "$place/there/slurm/job")

requeued=
for _ in $(seq 600); do
  task=$(squeue --noheader --states=RUNNING --format=%i --jobs="$job" 2>/dev/null | head -n 1)
  if [ -z "$requeued" ] && [ -n "$task" ] && scontrol requeue "$task"; then requeued=$task; fi
  [ -n "$(squeue --noheader --format=%i --jobs="$job" 2>/dev/null)" ] || break
  sleep 0.2
done
"$program" sweep status "$place/there"
"$program" sweep collect "$place/there"
[ -n "$requeued" ] || { echo "slurm_test: no shard could be requeued while it ran" >&2; exit 1; }
diff <(without_timing "$place/local/table.csv") <(without_timing "$place/there/table.csv") >/dev/null || {
  echo "slurm_test: the tables differ" >&2
  exit 1
}
lines=$(cat "$place"/there/results/*.log | wc -l)
[ "$lines" -eq 400 ] || { echo "slurm_test: $lines results of 400 runs" >&2; exit 1; }
echo "slurm_test: 400 runs in 8 shards, shard $requeued requeued, the table is that of a local run"
