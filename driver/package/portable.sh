#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Puts the program and every library that it loads, the C library too, into one folder, which runs on
# any Linux of this processor, from anywhere and without rights, and packs it.
#   portable.sh [BUILD]         makes BUILD/binderjet-VERSION-linux-PROCESSOR.tar.xz
#   portable.sh BUILD FOLDER    makes the folder alone, which must not be there yet
set -euo pipefail
paths=()
for path in "$@"; do paths+=("$(realpath -m "$path")"); done
set -- "${paths[@]}"
cd "$(dirname "$0")/../.."
build=${1:-build}
if [ ! -x "$build/binderjet" ] || [ ! -e "$build/manual/binderjet.1" ]; then
  bash tests/build.sh package "$build"
fi
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:.*=//p' "$build/CMakeCache.txt")
name=binderjet-$version-linux-$(uname -m)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
folder=${2:-$work/$name}
mkdir "$folder"

# The loader lies in lib/, a folder beside share/ as bin/ is: to the program, which looks for its
# profiles from where it was started, it is the loader that was started.
DESTDIR=$work/installed cmake --install "$build" --prefix / --strip > "$work/log"
mkdir "$folder/bin" "$folder/lib"
mv "$work/installed/bin/"* "$folder/lib/"
mv "$work/installed/share" "$folder/"
mkdir "$folder/share/binderjet/udev"
cp udev/* "$folder/share/binderjet/udev/"
for program in binderjet binderjet-read; do
  install -m 755 driver/package/launcher.sh "$folder/bin/$program"
done
install -m 644 driver/package/portable.txt "$folder/README.txt"

# What oneTBB opens by name when it starts: without them it runs, but allocates more slowly.
loaded() {  # the files that the given ones are linked with, as the loader would find them
  ldd "$@" | awk '$2 == "=>" { print $3 } NF == 2 && $1 ~ /^\// { print $1 }'
}
tbb=$(dirname "$(loaded "$build/binderjet" | grep '/libtbb\.so')")
by_name=("$tbb"/libtbbmalloc.so.? "$tbb"/libtbbbind*.so.?)
mapfile -t libraries < <(
  { loaded "$build/binderjet" "$build/binderjet-read" "${by_name[@]}"; printf '%s\n' "${by_name[@]}"; } | sort -u)
cp -L "${libraries[@]}" "$folder/lib/"

# Whose the libraries are: each package's license, and the version of the source that Debian keeps.
terms=$folder/share/doc/libraries
mkdir "$terms"
# A package may have a file in /lib that is found in /usr/lib, or the other way round.
mapfile -t files < <(realpath "${libraries[@]}" | sed 's#^/usr##' | sort -u)
dpkg-query -S "${files[@]}" "${files[@]/#//usr}" > "$work/owners" 2> "$work/log" || true
sed 's#^.*: ##; s#^/usr##' "$work/owners" | sort -u > "$work/owned"
strangers=$(printf '%s\n' "${files[@]}" | comm -23 - "$work/owned")
if [ -n "$strangers" ]; then
  echo "portable.sh: in no Debian package, so of unknown license:" $strangers >&2
  exit 3
fi
mapfile -t packages < <(cut -d: -f1 "$work/owners" | sort -u)
for package in "${packages[@]}"; do
  cp -L "/usr/share/doc/$package/copyright" "$terms/$package.txt"
done
cp -rL /usr/share/common-licenses "$terms/"
dpkg-query -W -f '${binary:Package} ${Version}: apt-get source ${source:Package}=${source:Version}\n' \
  "${packages[@]}" > "$terms/sources.txt"

[ $# -lt 2 ] || exit 0
# The same bytes each time that the same is packed.
time=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2> "$work/log" || date +%s)}
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mode=go=rX --mtime="@$time" \
  -c "$name" | xz -T2 > "$build/$name.tar.xz.part"
mv "$build/$name.tar.xz.part" "$build/$name.tar.xz"
du -h "$build/$name.tar.xz"
