#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Unpacks Debian's kernel, never installs it: kernel.sh DIR leaves DIR/vmlinux, DIR/version and the
# modules in DIR/root.
set -euo pipefail
export LC_ALL=C  # bytes are bytes
mkdir -p "$1"
cd "$1"

# The cloud kernel has no USB, so this is the one that plain machines run.
package=$(apt-cache depends linux-image-amd64 |
  awk '$1 == "Depends:" && $2 ~ /^linux-image-/ { print $2; exit }')
if [ -z "$package" ]; then
  echo "kernel.sh: apt does not know linux-image-amd64: run apt-get update" >&2
  exit 1
fi
version=${package#linux-image-}
want=$(apt-cache policy "$package" | awk '$1 == "Candidate:" { print $2 }')
[ ! -f "done-$version-$want" ] || exit 0

rm -rf root vmlinux version done-* linux-image-*.deb
apt-get download -q "$package" >download.log 2>&1 || {
  cat download.log >&2
  exit 1
}
mkdir root
modules=./lib/modules/*/kernel
dpkg-deb --fsys-tarfile linux-image-*.deb | tar x -C root --wildcards './boot/vmlinuz-*' \
  './lib/modules/*/modules.*' "$modules/drivers/usb/*" "$modules/drivers/virtio/*" \
  "$modules/drivers/block/virtio_blk.ko" "$modules/fs/*" "$modules/lib/*" "$modules/crypto/*"
depmod -b root "$version"

# QEMU starts an uncompressed kernel at once; a guest under TCG takes seconds to unpack it. Behind
# the compressed part stands more, of which xz complains when it has written everything.
at=$(grep -obUaP '\xfd7zXZ\x00' "root/boot/vmlinuz-$version" | sed -n '1s/:.*//p')
tail -c +$((at + 1)) "root/boot/vmlinuz-$version" | xz -dcq >vmlinux 2>/dev/null || true
if ! readelf -h vmlinux >/dev/null 2>&1; then
  echo "kernel.sh: found no kernel in vmlinuz-$version" >&2
  exit 1
fi
echo "$version" >version
rm linux-image-*.deb
touch "done-$version-$want"
