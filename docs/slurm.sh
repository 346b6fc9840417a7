#!/bin/bash
#SBATCH --ntasks=64
#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
# sbatch slurm.sh SCENE DIR: a survey that stops before its time is over and goes on in the next job of the same number.
# `B:` sends the signal to this script alone, 120 s before the end; mpirun passes SIGUSR1 on to its ranks.
mpirun orbweaver survey "$1" -o "$2" --resume &
survey=$!
trap 'kill -USR1 $survey' USR1
wait $survey
status=$?
if ((status > 128)); then # the signal ended the wait, not the survey
  wait $survey
  status=$?
fi
((status != 4)) || scontrol requeue "$SLURM_JOB_ID"
exit $status
