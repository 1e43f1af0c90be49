#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds what the guest boots from: guest.sh KERNEL_DIR OUT_DIR PROGRAM... -- FILE... leaves
# OUT_DIR/initramfs, which mounts the disk, and OUT_DIR/disk, which has everything else; the files
# stand in its root.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
kernel=$1 out=$2
shift 2
programs=()
while [ "$1" != -- ]; do programs+=("$1"); shift; done
shift

# Copies the modules and what they need, and the order to load them in, to a root.
take_modules() {
  local root=$1 version module
  shift
  version=$(cat "$kernel/version")
  mkdir -p "$root/modules"
  for module in "$@"; do
    modprobe -d "$kernel/root" -S "$version" --show-depends "$module"
  done | awk '$1 == "insmod" && !seen[$2]++ { print $2 }' | while read -r file; do
    cp "$file" "$root/modules/"
    echo "/modules/${file##*/}" >>"$root/modules/order"
  done
}

# The first root: small, because the guest unpacks it slowly.
first=$out/first
mkdir -p "$first"/{bin,dev,root}
cp "$(command -v busybox)" "$first/bin/"
cp "$here/first_init" "$first/init"
take_modules "$first" virtio_pci virtio_blk crc32c_generic ext4
(cd "$first" && find . | cpio -o -H newc --quiet -R 0:0) >"$out/initramfs"

# The second: 400 MB of libraries, of which the guest reads what it needs.
root=$out/root
mkdir -p "$root"/{bin,sbin,dev,etc,proc,sys,run,tmp,out,lib/systemd,lib/udev/rules.d}
cp "$(command -v busybox)" "$root/bin/"
cp "$(readlink -f "$(command -v udevadm)")" "$root/bin/udevadm"
ln -s /bin/udevadm "$root/lib/systemd/systemd-udevd"
cp "${programs[@]}" "$root/bin/"
# Each library under the name the loader looks for.
ldd "$root/bin/udevadm" "${programs[@]}" | grep -o '/[^ ]*\.so[^ ]*' | sort -u |
  xargs cp -L --parents -t "$root"
take_modules "$root" usblp usbmon xhci-pci
cp "$here/init" "$root/init"
cp "$@" "$root/"

cp /lib/udev/rules.d/50-udev-default.rules "$root/lib/udev/rules.d/"
cp "$here/../../../../udev/60-binderjet.rules" "$root/lib/udev/rules.d/"
# udevd skips a rule whose group nobody knows. One user is in lp, one is not.
number=900
{
  echo root:x:0:
  cat "$root"/lib/udev/rules.d/*.rules | grep -o 'GROUP="[a-z]*"' | cut -d'"' -f2 | sort -u |
    while read -r group; do
      members=""
      [ "$group" != lp ] || members=printing
      echo "$group:x:$((number++)):$members"
    done
  echo nobody:x:1000:
} >"$root/etc/group"
cat >"$root/etc/passwd" <<'END'
root:x:0:0::/:/bin/sh
printing:x:1001:1000::/tmp/printing:/bin/sh
stranger:x:1002:1000::/tmp/stranger:/bin/sh
END
chmod 755 "$root"

megabytes=$(($(du -sm "$root" | cut -f1) + 100))
mke2fs -q -t ext2 -b 4096 -E root_owner=0:0 -d "$root" "$out/disk" "${megabytes}M" >/dev/null
rm -rf "$first" "$root"
