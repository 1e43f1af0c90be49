#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What a person does with the installed program and no printer, on parts of a few layers, through
# every library: jobs.sh BINDERJET FOLDER. Prints a checksum of each file whose bytes must be the same
# wherever the program runs.
set -eu
binderjet=$1
cd "$2"

"$binderjet" profile list > profiles.txt
"$binderjet" coupon --kind slots -o slots.stl -q
for enhance in none paper inverse; do
  "$binderjet" slice slots.stl -p z450 --scale 0.25 --enhance $enhance -o $enhance.bjob -q
  "$binderjet" export $enhance.bjob -o $enhance -q
done
"$binderjet" export inverse.bjob --html page.html -q
"$binderjet" export inverse.bjob --3mf stack.3mf -q
"$binderjet" export inverse.bjob --zip stack.zip -q
"$binderjet" simulate inverse.bjob -p z450 -o printed -q
"$binderjet" score inverse.bjob --target slots.stl --json > score.json
"$binderjet" print inverse.bjob --to spool:spool -q

# A printer that puts down less binder than its profile says.
"$binderjet" profile show z450 > z450.toml
sed 's/^level = .*/level = 0.4/' z450.toml > other.toml
"$binderjet" simulate none.bjob -p other.toml -o measured -q
"$binderjet" calibrate -p z450 --job none.bjob --measured measured -o calibrated -q

# Colors: Wavefront with a picture, VRML through Coin, glTF through assimp.
cat > picture.mtl << 'END'
newmtl skin
map_Kd none/mask_000004.png
END
cat > picture.obj << 'END'
mtllib picture.mtl
v 0 0 0
v 4 0 0
v 0 4 0
v 0 0 4
vt 0 0
vt 1 0
vt 0 1
usemtl skin
f 1/1 3/3 2/2
f 1/1 2/2 4/3
f 1/1 4/3 3/2
f 2/1 3/2 4/3
END
cat > red.wrl << 'END'
#VRML V2.0 utf8
Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } }
  geometry IndexedFaceSet {
    coord Coordinate { point [0 0 0, 4 0 0, 0 4 0, 0 0 4] }
    coordIndex [0 2 1 -1 0 1 3 -1 0 3 2 -1 1 2 3 -1]
  }
}
END
# Four points, and twelve corners of triangles.
buffer=AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAgEAAAAAAAAAAAAAAAAAAAIBA
buffer=${buffer}AAACAAEAAAABAAMAAAADAAIAAQACAAMA
cat > red.gltf << END
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
 "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
   "min": [0, 0, 0], "max": [4, 4, 4]},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48},
                 {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
 "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,$buffer"}]}
END
for part in picture.obj red.wrl red.gltf; do
  "$binderjet" slice $part -p z450 --enhance none -o $part.bjob -q
  "$binderjet" export $part.bjob --what color -o $part.color -q
done

# What a spool calls a job, and when it came, is not the same twice.
find . -type f ! -path './spool/*' | LC_ALL=C sort | xargs sha256sum
find spool -type f -name '*.bjob' -exec sha256sum {} + | cut -d' ' -f1
