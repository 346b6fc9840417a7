# Sourced by the scripts that break surveys off. They are called with
#   PROGRAM COMPARE SCENE FOLDER [options of survey ...]
# and run `survey`, which prints nothing, in FOLDER/NAME; FOLDER/whole holds the undisturbed run that `expect_same` compares
# with.
set -u
program=$1 compare=$2 scene=$3 folder=$4
shift 4
options=("$@")
export OMPI_MCA_rmaps_base_oversubscribe=1

fail() {
  echo "$1"
  tail -25 "$folder/log"
  exit 1
}

# survey NAME RANKS [more options ...]: its exit status is that of mpirun. Open MPI 4.1's mpirun locks up now and then as it
# ends after a rank was killed (in PMIx_server_finalize): a minute after its last rank it is killed.
survey() {
  mpirun -n "$2" "$program" survey "$scene" -o "$folder/$1" --quiet "${options[@]}" "${@:3}" >> "$folder/log" 2>&1 &
  local launcher=$! turns=0 alone=0
  while kill -0 $launcher 2> /dev/null; do
    sleep 0.05
    turns=$((turns + 1))
    [ $((turns % 20)) = 0 ] || continue
    if [ -n "$(ranks_of "$1")" ]; then alone=0; else alone=$((alone + 1)); fi
    if [ $alone -ge 60 ]; then
      echo "mpirun did not end with its ranks: killed" >> "$folder/log"
      kill -9 $launcher
    fi
  done
  wait $launcher
}

# held SECONDS PLACE survey ...: that survey, standing still for so long where it comes to PLACE (core::pause_point), so that it
# cannot be through before it is asked to stop, however fast the machine.
held() {
  ORBWEAVER_PAUSE_AT=$2 ORBWEAVER_PAUSE_SECONDS=$1 "${@:3}"
}
wait_until_held() {
  until grep -q "paused at" "$folder/log"; do
    kill -0 "$1" 2> /dev/null || fail "the run ended without coming to the place where it was to be held"
    sleep 0.02
  done
}

# Waits until no process of the survey in FOLDER/NAME is left.
wait_for_end() {
  while pgrep -f -- "-o $folder/$1 --quiet" > /dev/null; do sleep 0.05; done
}

# The processes of the ranks, rank 0 first.
ranks_of() {
  pgrep -f -- "^$program survey .* -o $folder/$1 --quiet" | sort -n
}
mpirun_of() {
  pgrep -f -- "^mpirun .* -o $folder/$1 --quiet" | head -1
}

expect_same() {
  "$compare" "$folder/whole/atlas.h5" "$folder/$1/atlas.h5" >> "$folder/log" 2>&1 || fail "$1: the archive differs from the undisturbed run's"
}

begin_anew() {
  rm -rf "$folder"
  mkdir -p "$folder"
}

milliseconds() {
  echo $(($(date +%s%N) / 1000000))
}
