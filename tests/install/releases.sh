#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs a package in new roots of Debian's releases, runs jobs.sh there as nobody, and compares all
# that it makes, byte for byte, with what the built program makes here. Needs root and debootstrap;
# a minute for each release.
#   releases.sh build/binderjet_*.deb bookworm
#   releases.sh build/binderjet-*.tar.xz bullseye trixie
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
package=$(realpath "$1")
built=$(dirname "$package")/binderjet
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/expected"
sh "$here/jobs.sh" "$built" "$work/expected" > "$work/expected.sums"
for release in "${@:2}"; do
  root=$work/$release
  debootstrap --variant=minbase "$release" "$root" > "$work/log" || { cat "$work/log"; exit 1; }
  cp "$here/jobs.sh" "$root/jobs.sh"
  cp "$package" "$root/tmp/"
  in_root() { unshare --mount --pid --fork --mount-proc="$root/proc" chroot "$root" "$@"; }
  case $package in
    *.deb)
      in_root apt-get update -qq
      in_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "/tmp/${package##*/}" > "$work/log" ||
        { cat "$work/log"; exit 1; }
      program=/usr/bin/binderjet
      ;;
    *.tar.xz)  # which only root's folder may hold that its users cannot write
      xz -dc "$package" | tar -x -C "$root/opt"
      program=/$(cd "$root" && echo opt/*/bin/binderjet)
      ;;
  esac
  install -d -o nobody "$root/tmp/jobs"
  in_root setpriv --reuid=nobody --regid=nogroup --clear-groups env -i \
    sh /jobs.sh "$program" /tmp/jobs > "$work/sums"
  diff "$work/expected.sums" "$work/sums"
  echo "$release: $(wc -l < "$work/sums") files are the same"
done
