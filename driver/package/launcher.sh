#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Starts binderjet with the loader and the libraries that lie beside it, not with this system's.
here=$(dirname "$(dirname "$(readlink -f "$0")")")
exec "$here"/lib/ld-linux-*.so.* --inhibit-cache --library-path "$here/lib" --argv0 "$0" \
  "$here/lib/binderjet" "$@"
