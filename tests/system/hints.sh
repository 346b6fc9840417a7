#!/bin/bash
# hints.sh PROGRAM FOLDER: hints are whole commands, which end as they should when they are run as they stand, for a model of one's own; and a model
# that contradicts itself is refused once, whatever the number of ranks.
set -u
program=$1 folder=$2
export OMPI_MCA_rmaps_base_oversubscribe=1
rm -rf "$folder"; mkdir -p "$folder/bin" && cd "$folder" || exit 1
ln -s "$program" bin/orbweaver
export PATH="$PWD/bin:$PATH"
fail() {
  echo "hints.sh: $*"
  exit 1
}
# ended STATUS TEXT COMMAND...
ended() {
  local expected=$1 text=$2 status=0
  shift 2
  "$@" >said.txt 2>&1 || status=$?
  ((status == expected)) || fail "'$*': status $status instead of $expected: $(cat said.txt)"
  grep -qF -- "$text" said.txt || fail "'$*' does not say '$text': $(cat said.txt)"
}
cat >model.yaml <<'END'
name: two_masses
coordinates: [q1, q2]
momenta: [p1, p2]
hamiltonian: (p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + c*(q1 - q2)^2/2 + (q1^4 + q2^4)/4
parameters: {c: 0.1}
reversors: {R: {p1: -p1, p2: -p2}}
END
cat >scene.yaml <<'END'
system: {model_file: model.yaml}
starts: {fixed_points: {grid: [[0], [0]]}}
limits: {energy: [0, 60]}
END
ended 4 'makes it of what there is' orbweaver survey scene.yaml -o 'out stopped' --walltime 0.01 --set continuation.step=0.001 -q
consolidate=$(sed -n 's/^archive: not written (\(.*\) makes it of what there is)$/\1/p' said.txt)
resume=$(sed -n 's/^  \(orbweaver survey .*\)$/\1/p' said.txt)
ended 4 '' bash -c "$consolidate"
ended 2 "orbweaver show 'out stopped/atlas.h5' families" orbweaver show 'out stopped' orbits --family none
rm 'out stopped/atlas.h5'
ended 2 "orbweaver consolidate 'out stopped'" orbweaver show 'out stopped'
ended 4 '' bash -c "$resume --walltime 0.01 -q"

sed 's/R: {p1: -p1, p2: -p2}/R: {q1: -q1}/; s/two_masses/wrong/' model.yaml >wrong_model.yaml
sed 's/model.yaml/wrong_model.yaml/' scene.yaml >wrong.yaml
for ranks in 1 2 3; do
  ended 2 'wrong_model.yaml' mpirun --quiet -n $ranks orbweaver survey wrong.yaml -o wrong
  (($(grep -c 'wrong_model.yaml' said.txt) == 1)) || fail "it is not named once: $(cat said.txt)"
  ! grep -qE '[ch]pp:[0-9]' said.txt || fail "a place in a source is named: $(cat said.txt)"
done
echo "hints are commands; refused once"
