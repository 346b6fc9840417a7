#!/usr/bin/env bash
# debian.sh SOURCE WORK VERSION: makes the Debian packages (or takes those in the folder ORBWEAVER_PACKAGES), installs them by apt into a
# Debian 12 that debootstrap makes in WORK, and runs the program there as an ordinary user (debian_inside.sh). Ends with 77, and says why,
# where that cannot be done.
set -euo pipefail
source=$1 work=$2 version=$3
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "debian.sh: $*" >&2; exit 1; }

((EUID == 0)) || skip "a system of its own needs root"
for tool in debootstrap dpkg-shlibdeps unshare; do
  command -v $tool >/dev/null || skip "there is no $tool here (Debian: debootstrap, dpkg-dev, util-linux)"
done
mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null |
  sed -nE 's/^(deb|URIs:)[^#]*(https?:[^ ]+debian)\/? ?.*/\2/p' | grep -v security | head -1 || true) # there may be no sources.list
mirror=${mirror:-http://deb.debian.org/debian}

mkdir -p "$work" && cd "$work"
packages=${ORBWEAVER_PACKAGES:-}
if [[ -z "$packages" ]]; then
  launcher=()
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  (cd "$source" && cmake --preset package "${launcher[@]}" && cmake --build --preset package && cpack --preset package)
  packages=$source/build/package
fi
program=$packages/orbweaver_${version}_$(dpkg --print-architecture).deb
development=$packages/orbweaver-dev_${version}_$(dpkg --print-architecture).deb
for file in "$program" "$development"; do
  [[ -f "$file" ]] || fail "expected $file"
  [[ "$(dpkg-deb -f "$file" Version)" == "$version" ]] || fail "$file has another version"
done
if command -v lintian >/dev/null; then
  # The developers have no address for mail.
  lintian --allow-root --fail-on error --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog "$program" "$development" ||
    fail "lintian finds errors"
fi

root=$work/root
[[ ! -e "$root" ]] || rm -rf --one-file-system "$root"
debootstrap --variant=minbase bookworm "$root" "$mirror" >debootstrap.log 2>&1 ||
  skip "debootstrap cannot make a Debian 12 from $mirror: $(tail -1 debootstrap.log)"
cp /etc/resolv.conf "$root/etc/resolv.conf"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" && chmod +x "$root/usr/sbin/policy-rc.d"
mkdir "$root/packages" && cp "$program" "$development" "$root/packages/"
cp -r "$source/tests/package" "$root/packages/tests"
# What is mounted here is gone when the command ends.
unshare --mount --pid --fork sh -c "mount -t proc proc '$root/proc' && mount --rbind /dev '$root/dev' && mount -t tmpfs none '$root/dev/shm' &&
  exec chroot '$root' env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 OMPI_MCA_rmaps_base_oversubscribe=1 \
    http_proxy='${http_proxy:-}' https_proxy='${https_proxy:-}' bash /packages/tests/debian_inside.sh"
rm -rf --one-file-system "$root"
