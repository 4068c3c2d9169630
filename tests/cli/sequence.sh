#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin estimate of sequences: what flickers less, what is refused, and what an interrupted or damaged one leaves.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
unset MERLIN_MODEL
demo=${MERLIN_SOURCE_DIR:?}/examples/demo.png
page=$MERLIN_SOURCE_DIR/docs/json.md
cd "$scratch" || exit 1
# The network at its smallest: what is tested is around it.
estimate() { "$MERLIN" estimate --model merlin-point --size 64 --views 1 "$@"; }
# number NAME...: a number of the JSON that succeeds has just got, by its names from outside in.
number() {
    local text
    text=$(tr -d '\n\t ' <stdout)
    for name in "$@"; do text=${text#*\"$name\":}; done
    echo "${text%%[,\}]*}"
}
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }

mkdir still moving
"$SEQUENCE_FRAMES" "$demo" still still 6 || complain "no frames were made"
"$SEQUENCE_FRAMES" "$demo" moving moving 6 || complain "no frames were made"

echo "a still object flickers less"
succeeds '"apart":true' estimate --sequence still -o apart --smooth 0 --json
before=$(number flicker after albedo)
succeeds '"apart":false' estimate --sequence still -o steady --json
after=$(number flicker after albedo)
less "$after" "$(awk -v b="$before" 'BEGIN { print b / 6 }')" || complain "albedo differs by $after, before by $before"
less "$(number flicker after normal)" "$(number flicker before normal)" || complain "normals differ as much as before"
for key in $(grep -oE '"[A-Za-z_0-9]+":' stdout | tr -d '":' | sort -u); do
    grep -qE "\`$key\`" "$page" || complain "$key is not on the page of JSON"
done
present steady/sequence.json steady/frame_0001/maps.exr steady/frame_0006/report.json
[ "$(grep -o '"crop":{[^}]*}' stdout | sort -u | wc -l)" = 1 ] || complain "the crop of a still object moved"

echo "a moving object is followed"
succeeds '"shift":\[6,2\]' estimate --sequence moving -o moved --json
[ "$(grep -o '"shift":\[6,2\]' stdout | wc -l)" = 5 ] || complain "not all shifts were found: $(cat stdout)"
[ "$(grep -o '"object":"followed"' stdout | wc -l)" = 5 ] || complain "it was not followed"
[ "$(number flicker pairs)" = 5 ] || complain "its flicker was not measured"

echo "frames keep their numbers, and a gap is told"
mkdir gap
cp still/frame_0001.png still/frame_0002.png still/frame_0005.png gap
succeeds '^gap/frame_%04d.png: 3 frames in gap/frame.merlin' estimate 'gap/frame_%04d.png'
grep -q 'frames are missing (2), first 3' stderr || complain "no word of the gap: $(cat stderr)"
present gap/frame.merlin/frame_0005/maps.exr
absent gap/frame.merlin/frame_0003
succeeds '"frames_missing"' estimate gap/frame_0005.png gap/frame_0001.png gap/frame_0002.png --sequence -o gap.maps --json
succeeds '"code":"frames_left","message":"1 frame of an earlier run is still beside these, frame_0005 first"' \
    estimate gap/frame_0001.png gap/frame_0002.png --sequence -o gap.maps --json
grep -q 'frame_0005 first' stderr || complain "no word of a frame of an earlier run: $(cat stderr)"

echo "a cut begins anew"
mkdir cut
cp still/frame_0001.png cut/1.png
cp still/frame_0002.png cut/2.png
"$SEQUENCE_FRAMES" "$MERLIN_SOURCE_DIR/examples/window.png" cut moving 1 && mv cut/frame_0001.png cut/3.png
succeeds '"cut":true' estimate --sequence cut -o cut.maps --json
grep -q 'another scene begins in 1 of 3 frames, first in 3' stderr || complain "no word of the cut: $(cat stderr)"

echo "several photographs without --sequence are what they were"
succeeds 'batch/frame_0002/overview.png' estimate gap/frame_0001.png gap/frame_0002.png -o batch
absent batch/sequence.json

echo "the mask of the first frame is followed"
cp apart/frame_0001/mask.png first.png
succeeds '"object":"given"' estimate 'still/frame_%04d.png' --mask first.png -o masked --json
[ "$(grep -o '"object":"followed"' stdout | wc -l)" = 5 ] || complain "a given mask was not followed: $(cat stdout)"

echo "a sequence is relit, by one light or by one that goes round"
succeeds '"sequence":6' "$MERLIN" relight steady --light 0.7,0.3,-0.4 --json
present steady/relit/frame_0001.png steady/relit/frame_0006.png
succeeds '^moved: turned' "$MERLIN" relight moved --orbit 6 --format jpg -o turned
present turned/frame_0006.jpg
cmp -s turned/frame_0001.jpg turned/frame_0004.jpg && complain "an orbit stands still"
if grep -q 'not written as a video' stderr; then absent turned/relit.mp4; else present turned/relit.mp4; fi
rm turned/frame_0006.jpg
cp turned/frame_0001.jpg turned/frame_0099.jpg
succeeds '^moved: turned' "$MERLIN" relight moved --light 0,0,0 --direction 1,0,1 --together --format jpg -o turned
grep -q 'earlier run is still beside these, frame_0099.jpg' stderr || complain "no word of what is left: $(cat stderr)"
refuses 2 'several lamps want --together' "$MERLIN" relight moved --light 0,0,0 --light 1,0,0
refuses 2 'not both' "$MERLIN" relight moved --light 0,0,0 --orbit 4
refuses 2 'no --dome' "$MERLIN" relight moved --dome 4
refuses 2 'merlin estimate still/frame_%04d.png, then' "$MERLIN" relight 'still/frame_%04d.png' --light 0,0,0
refuses 1 'does not have the light\|no light is known' "$MERLIN" relight moved --found-light -o none
rm moved/frame_0003/maps.exr
refuses 1 'there are no maps in moved/frame_0003' "$MERLIN" relight moved --light 0,0,0 -o none
absent none
printf '{"frames": []}' >moved/sequence.json
refuses 1 'moved/sequence.json is damaged' "$MERLIN" relight moved --light 0,0,0 -o none

echo "what is no sequence is refused"
refuses 2 '--smooth is for' estimate "$demo" --smooth 4
refuses 2 'no --share and no --resume' estimate --sequence still --share 1/2
refuses 2 'a mesh.glb in each frame' estimate --sequence still --mesh a.glb
refuses 2 'comes alone' estimate 'still/frame_%04d.png' "$demo"
refuses 1 'there is no picture' estimate 'nothing_%d.png'
refuses 1 'no number in its name' estimate --sequence "$demo"
refuses 1 'there is no photograph, video or folder nowhere' estimate --sequence nowhere
mkdir sizes
cp still/frame_0001.png sizes/1.png
cp "$demo" sizes/2.png
refuses 1 'one size; frames before it that are complete in sizes.merlin: 1' estimate --sequence sizes
present sizes.merlin/sequence.json sizes.merlin/frame_0001/maps.exr
absent sizes.merlin/frame_0002

echo "relit frames do not take the place of the photographs"
refuses 1 'still: its frame_0001.png is no earlier result, for there is no relit.mp4' "$MERLIN" relight steady --light 0.7,0.3,-0.4 -o still
cmp -s still/frame_0001.png gap/frame_0001.png || complain "a photograph was replaced"

echo "a frame that cannot be written is not listed, and a list stays as long as its frames do"
mkdir halves
touch halves/frame_0002
"$MERLIN" estimate --model merlin-point --size 64 --views 1 --sequence still -o halves >stdout 2>stderr && complain "a file was taken for a folder"
present halves/frame_0001/maps.exr
grep -q '"number":1,' <(tr -d '\n\t ' <halves/sequence.json) || complain "the first frame is not listed"
grep -q '"number":2,' <(tr -d '\n\t ' <halves/sequence.json) && complain "a frame is listed that is not there"
refuses 2 'lies outside' estimate --sequence still -o steady --point 99999,9
present steady/sequence.json

echo "an interrupted sequence leaves complete frames"
"$MERLIN" estimate --sequence still -o stopped >/dev/null 2>stderr &
worker=$!
await stopped/frame_0001/maps.exr
kill -TERM "$worker"
wait "$worker" && complain "an interrupted sequence succeeded"
grep -q 'interrupted; .* complete in stopped' stderr || complain "no word of what remains: $(cat stderr)"
for frame in stopped/frame_*; do present "$frame/maps.exr" "$frame/report.json"; done
[ -z "$(find stopped -name '.*')" ] || complain "hidden files were left: $(find stopped -name '.*')"

echo "a video is the sequence of its frames"
if ! "$SEQUENCE_FRAMES" "$demo" clip.mp4 still 4 2>stderr; then
    echo "skipped: $(cat stderr)"
    refuses 1 'FFmpeg' estimate clip.mp4
    finish
fi
succeeds '^clip.mp4: 4 frames in clip.merlin' estimate clip.mp4
present clip.merlin/frame_0004/maps.exr
grep -q '"rate":	25' clip.merlin/sequence.json || complain "the rate is lost"
head -c 20000 clip.mp4 >cut.mp4
refuses 1 'cut.mp4 is damaged or cut short' estimate cut.mp4
absent cut.merlin/sequence.json
refuses 2 'comes alone' estimate clip.mp4 clip.mp4

finish
