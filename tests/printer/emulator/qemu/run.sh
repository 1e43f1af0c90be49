#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Prints over 10 MB to the emulated printer through Debian's own kernel and compares what usbmon saw
# with the spool: run.sh FOLDER BINDERJET EMULATOR USBMON_CAPTURE MAKE_NOISY_JOB, all absolute.
# Needs no root and no KVM; FOLDER keeps the unpacked kernel for the next run.
set -euo pipefail
umask 022
export PATH=$PATH:/usr/sbin:/sbin
here=$(cd "$(dirname "$0")" && pwd)
folder=$1 binderjet=$2 emulator=$3 capture=$4 make_job=$5

for tool in qemu-system-x86_64 busybox cpio xz depmod udevadm mke2fs debugfs tshark readelf; do
  command -v "$tool" >/dev/null || {
    echo "run.sh: no $tool: bash tests/packages/install.sh package tests" >&2
    exit 1
  }
done
mkdir -p "$folder"
work=$(mktemp -d "$folder/run.XXXXXX")
machine="" printer=""
finish() {
  [ -z "$machine" ] || kill "$machine" 2>/dev/null || true
  [ -z "$printer" ] || kill "$printer" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap finish EXIT
step() { echo "$SECONDS s: $1"; }

"$here/kernel.sh" "$folder/kernel"
step "kernel $(cat "$folder/kernel/version")"
cd "$work"  # a socket's name must be short
"$make_job" job.bjob 1200 800 100
"$binderjet" print job.bjob --to spool:spool -q
"$here/guest.sh" "$folder/kernel" "$work" "$binderjet" "$capture" -- job.bjob
step "job, spool and guest"

timeout 120 qemu-system-x86_64 -machine q35,accel=tcg -cpu max -smp 2 -m 1024 -display none \
  -no-reboot -nic none -serial file:console -kernel "$folder/kernel/vmlinux" -initrd initramfs \
  -append "console=ttyS0 quiet panic=-1" -drive file=disk,format=raw,if=none,id=disk,cache=unsafe \
  -device virtio-blk-pci,drive=disk -chardev socket,id=usb,path=usb,server=on,wait=off \
  -device qemu-xhci,id=xhci -device usb-redir,chardev=usb,bus=xhci.0 &
machine=$!
"$emulator" --usbredir usb -o printed >printer.log 2>&1 &
printer=$!
status=0
wait "$machine" || status=$?
machine=""
step "the guest ran and switched off (exit status $status)"
kill "$printer" 2>/dev/null || true
wait "$printer" || status=$?
printer=""

debugfs -R "rdump /out ." disk 2>debugfs.log
if [ "$status" -ne 0 ] || [ ! -s out/checks ]; then
  cat console printer.log debugfs.log
  echo "FAIL: the guest or the emulator did not come to its end (exit status $status)"
  exit 1
fi
cat out/checks printer.log
if grep -q FAIL out/checks; then
  tail -n 30 out/node out/*.err out/*.out out/*.status out/dmesg console
  exit 1
fi
grep -q "100 of 100 layers$" printer.log || {
  echo "FAIL: the emulator has not printed the job"
  exit 1
}
"$here/compare.py" out/capture.pcap job.bjob spool/done/*.bjob
step "pass"
