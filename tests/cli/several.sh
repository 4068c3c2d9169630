#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin stereo of several photographs of which no light is known: a folder's, some named one by one, a video's.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
unset MERLIN_MODEL
cd "$scratch" || exit 1
any=${MERLIN_SOURCE_DIR:?}/models/merlin-any.safetensors
# The network at its smallest: what is tested is around it.
stereo() { "$MERLIN" stereo --model "$any" --size 64 --views 1 "$@"; }
# within NUMBER LIMIT: whether it is a number below the limit.
within() { [[ $1 =~ ^[0-9.]+$ ]] && awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

"$MERLIN" estimate "$MERLIN_SOURCE_DIR/examples/demo.png" --size 64 --views 1 -o maps --quiet || complain "no maps"
"$MERLIN" relight maps --dome 20 -o dome --quiet || complain "no pictures under a dome"

echo "the pictures of a folder are seen together by a model of any light"
mkdir folder two
cp dome/dome_00[0-7].png dome/mask.* folder
succeeds '"photographs":8' stereo folder --json -o together
present together/{maps.exr,confidence.png,albedo.png,normal.png,roughness.png,depth.png,mask.png,overview.png,report.json,mesh.glb}
succeeds '"photographs":8' stereo folder --method universal --json --mesh a.obj --html -o together
present together/viewer.html a.obj
succeeds relit "$MERLIN" relight together --model "$any" --light 0.7,0.2,-0.4 -o relit
cp dome/dome_000.png dome/dome_001.png dome/mask.* two
succeeds '"photographs":2' stereo two --json
grep -q '"further_light":{"words":"a lamp ' stdout || complain "it does not say which light tells most: $(cat stdout)"
succeeds 'next, a lamp .* tells most$' stereo two
refuses 2 'is for flashes' "$MERLIN" stereo folder --method universal --model merlin-point

refuses 2 '--integrate is for pictures with a list of lights' stereo folder --integrate edges
refuses 2 '--distance is for pictures with a list of lights' stereo folder --fov 40 --distance 5

echo "near lamps before a known lens are found again by a network"
"$MERLIN" relight maps --dome 5 --near -o lamps --quiet || complain "no pictures under near lamps"
mkdir torch
cp lamps/dome_*.png lamps/mask.* torch
succeeds '"refined":true' "$MERLIN" stereo torch --size 64 --views 1 --fov 60 --json -o torch.maps
grep -q lights_far stdout && complain "lamps before a known lens are taken to be far: $(cat stdout)"
within "$("$NORMALS_DIFFER" torch.maps maps)" 12 || complain "its normals are another object's"

echo "a ring of near lamps flattens what it finds, and the networks' shape stays"
"$MERLIN" relight maps --orbit 16 --frame 256 -o orbit --quiet || complain "no orbit"
mkdir ring
cp orbit/frame_*.png ring
succeeds '"refined":false' "$MERLIN" stereo ring --size 64 --views 1 --json -o ring.maps

echo "what is wrong with the files is told"
cp dome/dome_001.png two/dome_002.png
cp dome/mask.webp two/other_mask.webp
succeeds '"code":"same_pictures"' stereo two --json
grep -q '"code":"files_skipped"' stdout || complain "no word of the file that is no picture: $(cat stdout)"
grep -q '"same_pictures"' two/stereo/report.json || complain "the report does not tell that two are the same"

echo "pictures named one by one"
succeeds '"photographs":3' stereo dome/dome_00[0-2].png --mask dome/mask.webp --json -o three
present three/maps.exr three/mesh.glb
succeeds '^dome/dome_000.png: ' stereo dome/dome_000.png dome/dome_001.png
present dome/dome_000.merlin/stereo/{maps.exr,confidence.png}
mkdir one
cp dome/dome_000.png dome/mask.webp one
succeeds '"files":\["one/stereo/albedo.png","one/stereo/depth.png"' stereo one --method universal --json
present one/stereo/maps.exr
absent one/stereo/confidence.png
refuses 2 'folder is a folder, which comes alone' stereo dome/dome_000.png folder
refuses 2 'standard input, which comes alone' stereo dome/dome_000.png -
refuses 1 'there is no picture absent.png' stereo dome/dome_000.png absent.png
refuses 2 'for a folder of pictures, not for pictures one by one' "$MERLIN" stereo dome/dome_00[0-2].png --lights dome/dome.lp
radiance small.hdr 64 22
refuses 1 'small.hdr is 64 x 64 pixels, but dome/dome_000.png is 512 x 512' stereo dome/dome_000.png small.hdr
refuses 2 'is for a video' stereo folder --frames 4

echo "the frames of a video whose light differs most"
if ! "$PICTURES_VIDEO" clip.mp4 3 dome/dome_*.png 2>stderr; then
    echo "skipped: $(cat stderr)"
    finish
fi
succeeds '"photographs":16' stereo clip.mp4 --json
present clip.merlin/stereo/{maps.exr,mesh.glb}
grep -q '"refined":true' stdout || complain "no surface was found by stereo: $(cat stdout)"
grep -q '"code":"lights_far"' stdout || complain "no word of the lens that nobody knows: $(cat stdout)"
within "$("$NORMALS_DIFFER" clip.merlin/stereo maps)" 12 || complain "its normals are another object's"
succeeds '"photographs":5' stereo clip.mp4 --frames 5 --json -o five
refuses 2 'not for the video clip.mp4' "$MERLIN" stereo clip.mp4 --near
refuses 2 'which this method does not allow' "$MERLIN" stereo clip.mp4 --method robust
refuses 2 'are for a folder of pictures' "$MERLIN" stereo clip.mp4 --linear
refuses 2 'clip.mp4 is a video, which comes alone' stereo dome/dome_000.png clip.mp4
"$PICTURES_VIDEO" still.mp4 12 dome/dome_000.png || complain "no video"
succeeds '"code":"light_still"' stereo still.mp4 --json
grep -q '"photographs"' stdout && complain "a still video has other frames than one: $(cat stdout)"
head -c 20000 clip.mp4 >cut.mp4
refuses 1 'cut.mp4 is damaged or cut short' stereo cut.mp4
absent cut.merlin

finish
