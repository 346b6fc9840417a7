#!/usr/bin/env bash
# own_system.sh DOCUMENT PREFIX [all]: writes the files that the document shows (```cpp NAME, ```yaml NAME) and runs its commands (```sh) in the
# order in which they stand, with the package installed at PREFIX. Then what a plugin is refused for; with `all` what takes
# compiling two more.
set -euo pipefail
document=$1 prefix=$2 extent=${3:-some}
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
export PATH="$prefix/bin:$PATH"
rm -rf own && mkdir own && cd own

fail() {
  echo "own_system.sh: $*" >&2
  exit 1
}
ran=0
. "$here/../documents/read.sh"
on_file() { printf '%s' "$3" >"$2"; }
on_fault() { fail "$document:$1: $2"; }
on_command() {
  echo "== $2"
  bash -c "$2" </dev/null || fail "'$2' ended with status $?"
  ran=$((ran + 1))
}
read_document "$document"
((ran >= 7)) || fail "only $ran commands found in $document"
orbweaver show out/atlas.h5 >shown.txt
grep -q 'q1, q2, p1, p2' shown.txt || fail "the archive does not name the coordinates"

orbweaver show out/atlas.h5 orbits --csv >orbits.csv
# In the first family both masses swing alike, to rounding, however far it has been followed: extrapolation multiplies what is not.
awk -F, 'NR == 1 {for (n = 1; n <= NF; ++n) at[$n] = n; next}
  $at["family"] == "Equilibrium 1, mode 1" || $at["family"] == 0 {
    apart = $at["state_q1"] - $at["state_q2"]; if (apart < 0) apart = -apart
    if (apart > 1e-14 * (1 + $at["state_q1"])) exit 1
    ++rows
  }
  END {exit rows < 20}' orbits.csv || fail "the masses do not swing alike: $(cut -d, -f1-6 orbits.csv | tail -3)"

# A drive declares its half turn: nothing is missing, and the response turns twice.
orbweaver check response.yaml >checked.txt
! grep -q 'not declared' checked.txt || fail "check misses a symmetry: $(grep 'not declared' checked.txt)"
grep -q 'H: -x, -v, phase + 180 deg' checked.txt || fail "check does not know H: $(grep symmetries checked.txt)"
(($(orbweaver show out_response crossings --csv | grep -c fold-parameter) == 2)) || fail "the response does not turn twice"

# expect_refusal TEXT COMMAND ...
expect_refusal() {
  local text=$1 status=0
  shift
  "$@" >refused.txt 2>&1 || status=$?
  ((status == 2)) || fail "'$*': status $status instead of 2: $(cat refused.txt)"
  grep -qF "$text" refused.txt || fail "'$*' does not say '$text': $(cat refused.txt)"
}
expect_refusal "give it by \`--plugin FILE\`" orbweaver verify out/atlas.h5
# Hints are whole commands, which end as they should when they are run as they stand: consolidate, and how the survey goes on.
status=0
orbweaver survey two_masses.yaml -o 'out stopped' --walltime 0.01 --set continuation.step=0.001 -q >stopped.txt 2>&1 || status=$?
((status == 4)) || fail "a survey without time ends with $status: $(cat stopped.txt)"
status=0
bash -c "$(sed -n 's/^archive: not written (\(.*\) makes it of what there is)$/\1/p' stopped.txt)" >consolidated.txt 2>&1 || status=$?
((status == 4)) || fail "the hint of consolidate ends with $status: $(cat stopped.txt consolidated.txt)"
expect_refusal "orbweaver show 'out stopped/atlas.h5' families --plugin " orbweaver show 'out stopped' orbits --family none --plugin two_masses.so
rm 'out stopped/atlas.h5'
expect_refusal "orbweaver consolidate 'out stopped' --plugin " orbweaver show 'out stopped' --plugin two_masses.so
status=0
bash -c "$(sed -n 's/^  \(orbweaver survey .*\)$/\1/p' stopped.txt) --walltime 0.01 -q" >resumed.txt 2>&1 || status=$?
((status == 4)) || fail "the hint to go on ends with $status: $(cat stopped.txt resumed.txt)"

# As if built from another source.
hash=$(strings two_masses.so | grep -xE '[0-9a-f]{40}')
LC_ALL=C sed "s/$hash/${hash//[0-9]/0}/" two_masses.so >other.so
expect_refusal "expected a plugin of this source" orbweaver verify --plugin other.so out/atlas.h5
expect_refusal "there is another one of that name" orbweaver verify --plugin other.so --plugin two_masses.so out/atlas.h5
sed 's/two_masses.so/other.so/' two_masses.yaml >other.yaml
expect_refusal "plugin_source" mpirun -n 2 orbweaver survey other.yaml -o out --resume
expect_refusal "cannot be loaded" orbweaver verify --plugin two_masses.yaml out/atlas.h5
expect_refusal "it does not exist" orbweaver verify --plugin nowhere.so out/atlas.h5
# A structure that does not fit its model: the item is named once, whatever the number of ranks, and no place in Orbweaver's own sources.
sed 's/"two_masses"/"wrong"/; s/{"energy"}/{"energy", "momentum"}/' two_masses.cpp >wrong.cpp
sed 's/two_masses.so/wrong.so/' two_masses.yaml >wrong.yaml
orbweaver build-system wrong.cpp -o wrong.so
for ranks in 1 2 3; do
  expect_refusal "structure.conserved names 2 quantities (energy, momentum)" mpirun -n "$ranks" orbweaver survey wrong.yaml -o wrong
  (($(grep -c "the plugin's system 'wrong' (.*/wrong.so)" refused.txt) == 1)) || fail "the plugin is not named once: $(cat refused.txt)"
  ! grep -qE '[ch]pp:[0-9]' refused.txt || fail "a place in a source is named: $(cat refused.txt)"
done
if [[ "$extent" == all ]]; then
  sed 's/"wrong"/"false"/; s/{"energy", "momentum"}/{"energy"}/; s/{"R", back}/{"R", minus}/; s/{"M", minus}, //' wrong.cpp >false.cpp
  sed 's/two_masses.so/false.so/' two_masses.yaml >false.yaml
  orbweaver build-system false.cpp -o false.so
  expect_refusal "false.so) contradicts its structure: expected f(R z) = -R f(z)" mpirun -n 2 orbweaver survey false.yaml -o false
  # A Hamiltonian system that forgets to name its energy.
  sed 's/"two_masses"/"forgetful"/; /structure.conserved =/d; /structure.symplectic =/d' two_masses.cpp >forgetful.cpp
  sed 's/two_masses.so/forgetful.so/' two_masses.yaml >forgetful.yaml
  orbweaver build-system forgetful.cpp -o forgetful.so
  expect_refusal "forgetful.so): structure.conserved does not name conserved<0>, which the field keeps" orbweaver check forgetful.yaml
  expect_refusal "forgetful.so): structure.conserved does not name conserved<0>, which the field keeps" mpirun -n 2 orbweaver survey forgetful.yaml -o forgetful
fi
# A copy of the program alone has no headers to compile with: that is not the model's fault.
status=0
bare=$(mktemp -d)  # outside the folder that the program was built in, where it knows its own headers
mkdir "$bare/bin" && cp "$prefix/bin/orbweaver" "$bare/bin/"
"$bare/bin/orbweaver" build-system two_masses.cpp -o bare.so >refused.txt 2>&1 || status=$?
rm -r "$bare"
((status == 3)) && grep -qF "run the program from where it was built or installed" refused.txt || fail "a bare copy: $(cat refused.txt)"
echo 'int nothing;' >nothing.cpp
expect_refusal "has no symbol \`orbweaver_plugin\`" orbweaver build-system nothing.cpp -o nothing.so
grep -q '^compiling nothing.cpp' refused.txt || fail "build-system does not say what takes so long: $(cat refused.txt)"
echo 'int nothing' >nothing.cpp
expect_refusal "does not compile" orbweaver build-system nothing.cpp -o nothing.so
# The first bytes of the table are its ABI version, its size and two texts; then come sizes of types.
at=$(nm -D two_masses.so | awk '$3 == "orbweaver_plugin" {print $1}')
section=$(readelf -SW two_masses.so | awk '$2 == ".data.rel.ro" || $3 == ".data.rel.ro" {for (n = 1; n < NF; ++n) if ($n == "PROGBITS") print $(n + 1), $(n + 2)}')
read -r address offset <<<"$section"
table=$((16#$at - 16#$address + 16#$offset))
# changed BYTE VALUE: a copy with one byte of the table changed
changed() {
  cp two_masses.so changed.so
  printf "\\x$2" | dd of=changed.so bs=1 seek=$((table + $1)) conv=notrunc status=none
}
changed 0 07
expect_refusal "it is of ABI version 7" orbweaver verify --plugin changed.so out/atlas.h5
changed 4 07
expect_refusal "its table has 7 bytes" orbweaver verify --plugin changed.so out/atlas.h5
changed 24 07
expect_refusal "with other types, a different compiler" orbweaver verify --plugin changed.so out/atlas.h5
# Ranks that see different files.
mkdir -p same else && cp two_masses.so same/ && cp two_masses.so else/
printf '\0' >>else/two_masses.so
expect_refusal "rank 1 loads another build of a plugin" \
  mpirun -n 1 --wdir "$PWD/same" orbweaver verify --plugin two_masses.so ../out/atlas.h5 : \
  -n 1 --wdir "$PWD/else" orbweaver verify --plugin two_masses.so ../out/atlas.h5
# Nothing is left of what was not finished.
leftover=$(find . -name '*.part' -o -name '*.d')
[[ -z "$leftover" ]] || fail "left over: $leftover"
echo "$ran commands of $document, and what is refused ($extent)"
