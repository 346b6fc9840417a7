#!/usr/bin/env bash
# processor.sh PROGRAM: on a processor that lacks what PROGRAM was compiled for, as qemu plays one, it says so and ends with status 3,
# not by an illegal instruction. On one that has all, it runs.
set -euo pipefail
program=$1
fail() { echo "processor.sh: $*" >&2; exit 1; }
command -v qemu-x86_64 >/dev/null || { echo "skipped: no qemu-x86_64 here (Debian: qemu-user)"; exit 77; }
status=0
said=$(qemu-x86_64 -cpu Nehalem "$program" --version 2>&1) || status=$?
((status == 3)) && grep -q 'compiled for processors with avx, which this one lacks' <<<"$said" || fail "status $status: $said"
status=0
said=$(OPENBLAS_CORETYPE=Haswell qemu-x86_64 -cpu max "$program" --version 2>&1) || status=$?
((status == 0)) && grep -q '^orbweaver [0-9]' <<<"$said" || fail "with everything at hand, status $status: $said"
