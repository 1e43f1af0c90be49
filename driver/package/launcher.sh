#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Starts the program of its own name with the loader and the libraries that lie beside it, not with
# this system's.
self=$(readlink -f "$0")
here=$(dirname "$(dirname "$self")")
export BINDERJET_READ="$here/bin/binderjet-read"
exec "$here"/lib/ld-linux-*.so.* --inhibit-cache --library-path "$here/lib" --argv0 "$0" \
  "$here/lib/$(basename "$self")" "$@"
