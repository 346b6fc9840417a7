#!/usr/bin/env bash
# Run by debian.sh as root of a fresh Debian 12 with the packages in /packages: installs the program and runs it as an ordinary user; without
# what is only recommended; with it; then the libraries, and a program against them.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
fail() { echo "debian_inside.sh: $*" >&2; exit 1; }
install() { apt-get -q install -y --no-install-recommends "$@" >apt.log 2>&1 || { tail -30 apt.log >&2; fail "apt cannot install $*"; }; }
as_user() { runuser -u user -- env -C /home/user HOME=/home/user PATH=/usr/bin:/bin bash -c "$1"; }
# expect_status STATUS COMMAND TEXT: COMMAND ends with STATUS and says TEXT.
expect_status() {
  local status=0 said
  said=$(as_user "$2" 2>&1) || status=$?
  ((status == $1)) && grep -qF "$3" <<<"$said" || fail "'$2': status $status instead of $1, or without '$3': $said"
}

apt-get -q update >apt.log 2>&1 || fail "apt-get update: $(tail -3 apt.log)"
install /packages/orbweaver_*.deb
useradd --create-home user
version=$(dpkg-query -W -f='${Version}' orbweaver)
expect_status 0 'orbweaver --version' "orbweaver $version"
scene=/usr/share/orbweaver/scenes/double_pendulum.yaml
quick='--set limits.period=8.5 --set starts.sweep.step=0.05 --set starts.sweep.period=[2,9]'
expect_status 0 "orbweaver check $scene" 'double_pendulum'
expect_status 0 "mpirun -n 2 orbweaver survey $scene -o out $quick" ', 0 failed'
expect_status 0 'orbweaver show out/atlas.h5 families' 'In-Phase'
expect_status 0 'orbweaver verify out/atlas.h5' ': all hold'
expect_status 0 'orbweaver page out/atlas.h5 -o atlas.html && head -c 15 atlas.html' '<!doctype html>'
expect_status 3 'orbweaver plot out/atlas.h5 tree -o tree.svg' 'gnuplot'
gzip -dc /usr/share/man/man1/orbweaver.1.gz | grep -q 'SH COMMANDS' || fail "no manual page"
[[ -s /usr/share/bash-completion/completions/orbweaver && -s /usr/share/zsh/vendor-completions/_orbweaver && -s /usr/share/fish/vendor_completions.d/orbweaver.fish ]] || fail "no completions"
gzip -dc /usr/share/doc/orbweaver/changelog.gz | grep -q "^orbweaver ($version)" || fail "no changelog"
grep -q 'd3-contour' /usr/share/doc/orbweaver/copyright || fail "no notice of what the page contains"
echo "the program alone: ok, $(dpkg-query -W | wc -l) packages"

install $(dpkg-query -W -f='${Recommends}' orbweaver | tr -d ',')
expect_status 0 'orbweaver plot out/atlas.h5 tree -o tree.svg && ls tree.svg' 'tree.svg'
echo "with what is recommended: ok, $(dpkg-query -W | wc -l) packages"

install /packages/orbweaver-dev_*.deb cmake ninja-build
as_user 'cp -r /packages/tests/project . && cmake -S project -B build -G Ninja >/dev/null && cmake --build build'
expect_status 0 build/consumer 'field 2 -9'
echo "a program against the libraries: ok, $(dpkg-query -W | wc -l) packages"

apt-get -q purge -y orbweaver orbweaver-dev >apt.log 2>&1 || fail "apt cannot purge: $(tail -3 apt.log)"
left=$(find / -xdev \( -path /proc -o -path /dev -o -path /packages -o -path /home -o -path '/var/*' \) -prune -o -iname '*orbweaver*' -print)
[[ -z "$left" ]] || fail "left after purging: $left"
