#!/usr/bin/env bash
# merlin stereo from outside: what it writes, and how it refuses.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
make_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors # other tests may run beside this one
cd "$scratch" || exit 1
stereo() { "$MERLIN" stereo "$@"; }

radiance disc.hdr 64 22
succeeds disc.merlin "$MERLIN" estimate disc.hdr --size 64
files=(maps.exr normal.png albedo.png depth.png mask.png error.png overview.png report.json)

echo "a dome of relit pictures is read back"
succeeds dome "$MERLIN" relight disc.merlin --dome 6 --lp -o dome
present dome/dome_00{0..5}.png dome/dome.lp dome/mask.png
absent dome/dome_006.png
[ "$(wc -l <dome/dome.lp)" -eq 7 ] || complain "dome.lp is not a count and six lines"
succeeds '"pictures": *6' stereo dome --method ls --json
present "${files[@]/#/dome/stereo/}" dome/stereo/mesh.{ply,obj,mtl,png,glb}

echo "meshes by name, depth that may jump"
succeeds out stereo dome --method ls --integrate edges --mesh a.ply --mesh b.glb -o out
present "${files[@]/#/out/}" a.ply b.glb
absent out/mesh.ply out/mesh.glb

echo "one photograph"
succeeds '"normal_spread_mean_degrees"' stereo disc.hdr --size 64 --json -o photo
present "${files[@]/#/photo/}" photo/mesh.glb

echo "wrong use"
refuses 2 'no folder' stereo
refuses 2 'one folder' stereo dome disc.hdr
refuses 2 '--method' stereo dome --method magic
refuses 2 '--integrate' stereo dome --integrate magic
refuses 2 'c.stl' stereo dome --mesh c.stl
refuses 2 'unknown option' stereo dome --nonsense
refuses 2 'for a folder' stereo disc.hdr --near
refuses 2 '--dome' "$MERLIN" relight disc.merlin --dome 1
refuses 2 '--lp' "$MERLIN" relight disc.merlin --orbit 4 --lp

echo "bad input"
refuses 1 'missing' stereo missing -o none
mkdir empty
refuses 1 'empty' stereo empty -o none
head -4 dome/dome.lp >short.lp
refuses 1 'short.lp' stereo dome --lights short.lp -o none
refuses 1 'missing.txt' stereo dome --lights missing.txt -o none
refuses 1 'missing.png' stereo dome --mask missing.png -o none
head -c 60 dome/mask.png >cut.png
refuses 1 'cut.png' stereo dome --mask cut.png -o none
cp -r dome sizes
rm -r sizes/stereo
cp disc.merlin/overview.png sizes/dome_003.png
refuses 1 'dome_003.png' stereo sizes -o none
refuses 1 'missing.safetensors' stereo disc.hdr --model missing.safetensors -o none
absent none empty/stereo sizes/stereo

echo "places that cannot be written"
refuses 1 '/proc/merlin' stereo dome --method ls -o /proc/merlin
refuses 1 '/proc/a.ply' stereo dome --method ls --mesh /proc/a.ply -o none
absent none
finish
