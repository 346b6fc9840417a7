#!/bin/bash
# Runs docs/slurm.sh as a batch system would: the signal goes to the script alone, which must end with status 4 and ask to be queued
# again; the next job comes to the archive of an undisturbed run. Arguments: those of survey_runs.sh, the options by the environment.
. "$(dirname "$0")/survey_runs.sh"
begin_anew
survey whole 2 || fail "the undisturbed run failed"

# The commands of the batch system, and the program with the options of the test.
mkdir "$folder/bin"
cat > "$folder/bin/orbweaver" <<END
#!/bin/bash
exec "$program" "\$@" ${options[*]}
END
printf '#!/bin/bash\nexec %s -n 2 "$@"\n' "$(command -v mpirun)" > "$folder/bin/mpirun"
printf '#!/bin/bash\necho "$@" >> %s\n' "$folder/requeued" > "$folder/bin/scontrol"
chmod +x "$folder"/bin/*
export PATH=$folder/bin:$PATH SLURM_JOB_ID=17
batch=$(dirname "$0")/../../docs/slurm.sh
grep -q '^#SBATCH --signal=B:USR1@' "$batch" || fail "the script asks for no signal"

ORBWEAVER_PAUSE_AT="write segment-000002.h5" ORBWEAVER_PAUSE_SECONDS=1 "$batch" "$scene" "$folder/job" >> "$folder/log" 2>&1 &
job=$!
wait_until_held $job
kill -USR1 $job
wait $job
[ $? = 4 ] || fail "the job did not end with status 4"
grep -qx "requeue 17" "$folder/requeued" || fail "the job did not ask to be queued again"
"$batch" "$scene" "$folder/job" >> "$folder/log" 2>&1 || fail "the next job failed"
[ "$(wc -l < "$folder/requeued")" = 1 ] || fail "a job that is done asked to be queued again"
expect_same job
