#!/bin/bash
# sbatch.sh SCRIPT...: what Slurm's own scheduler says of batch scripts (sbatch --test-only), with a slurmctld of our own that has one node of 64
# processors. Exit status 77 where Slurm is not installed. Nothing is queued, and no slurmd runs.
fail() { echo "sbatch.sh: $*" >&2; exit 1; }
for tool in sbatch slurmctld munged; do
  command -v $tool > /dev/null || { echo "skipped: there is no $tool here (Debian: slurm-client, slurmctld, munge)"; exit 77; }
done
folder=$PWD/slurm host=$(hostname -s) port=$((20000 + $$ % 20000))
rm -rf "$folder" && mkdir -p "$folder/state"
key=$(mktemp -d) # the way to a socket may be 107 letters long
stop() {
  for name in slurmctld munged; do
    [ ! -s "$key/$name.pid" ] || kill "$(cat "$key/$name.pid")" 2> /dev/null
  done
  rm -rf "$key"
}
trap stop EXIT
head -c 1024 /dev/urandom > "$key/key" && chmod 400 "$key/key" && chmod 711 "$key"
munged --force --key-file="$key/key" --socket="$key/socket" --pid-file="$key/munged.pid" --log-file="$folder/munged.log" \
  --seed-file="$key/seed" || fail "munged does not start: $(tail -1 "$folder/munged.log")"
cat > "$folder/slurm.conf" << END
ClusterName=trial
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$key/socket
StateSaveLocation=$folder/state
SlurmctldPidFile=$key/slurmctld.pid
SlurmctldLogFile=$folder/slurmctld.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SuspendProgram=/bin/true
ResumeProgram=/bin/true
SuspendTime=60
NodeName=$host NodeAddr=127.0.0.1 CPUs=64 State=CLOUD
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE
END
export SLURM_CONF=$folder/slurm.conf
slurmctld || fail "slurmctld does not start: $(tail -1 "$folder/slurmctld.log")"
for ((n = 0; n < 60; ++n)); do
  scontrol ping 2> /dev/null | grep -q 'is UP' && break
  sleep 0.5
done
scontrol ping | grep -q 'is UP' || fail "slurmctld does not answer: $(tail -1 "$folder/slurmctld.log")"

# said STATUS TEXT WORDS...: sbatch --test-only ends so.
said() {
  local status=$1 text=$2 answer got=0
  shift 2
  answer=$(sbatch --test-only "$@" 2>&1) || got=$?
  [ $got = "$status" ] && grep -q "$text" <<< "$answer" || fail "sbatch --test-only $*: status $got: $answer"
  echo "$answer"
}
for script in "$@"; do
  said 0 'to start at .* using 64 processors' "$script" scene.yaml out
done
# What it would say of a script that asks for what there is not.
sed 's/--ntasks=64/--ntasks=65/' "$1" > "$folder/too_many.sh"
said 1 'Requested node configuration is not available' "$folder/too_many.sh" scene.yaml out
sed 's/--signal=B:USR1@120/--signal=B:USER1@120/' "$1" > "$folder/no_signal.sh"
said 255 'Invalid --signal specification' "$folder/no_signal.sh" scene.yaml out
