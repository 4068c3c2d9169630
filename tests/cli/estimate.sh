#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin estimate from outside: what it writes, and how it refuses.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
# reads_mesh FILE: merlin-lab, where there is one, renders it.
reads_mesh() {
    [[ -z ${MERLIN_LAB:-} ]] || "$MERLIN_LAB" render --mesh "$1" --count 1 --size 64 --no-env -o "$scratch/rendered-${1##*/}" --quiet ||
        complain "$1 cannot be read"
}
make_tiny_model
make_bad_weights
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors # other tests may run beside this one
cd "$scratch" || exit 1
estimate() { "$MERLIN" estimate "$@"; }
small=(--size 64 -o out.merlin)

radiance disc.hdr 64 22
names="albedo.png depth.png maps.exr mask.png normal.png overview.png reconstruction.png report.json roughness.png"

echo "a photograph becomes a folder of maps"
succeeds disc.merlin/overview.png estimate disc.hdr --size 64
[ "$(ls -A disc.merlin | sort | tr '\n' ' ')" = "$names " ] || complain "disc.merlin has $(ls -A disc.merlin)"
for name in $names; do present "disc.merlin/$name"; done
bytes=$(cat disc.merlin/* | wc -c)
grep -qF " s, 9 files, $(((bytes + 500) / 1000)) kB)" "$scratch/stdout" || complain "not $bytes bytes: $(cat "$scratch/stdout")"
grep -q '"mask":.*"found"' disc.merlin/report.json || complain "report.json does not say how the mask came about"

echo "--json prints a report, --quiet nothing, --help explains"
succeeds '^{.*"exposure_gain".*}$' estimate disc.hdr "${small[@]}" --json
lists_its_files out.merlin $names
[ -z "$(estimate disc.hdr "${small[@]}" --quiet 2>&1)" ] || complain "--quiet was not"
succeeds --exposure estimate --help
rm -rf out.merlin

echo "a burnt-out photograph is called so"
burn_out disc.hdr white.hdr
succeeds '"burnt_out":1,' estimate white.hdr "${small[@]}" --json
grep -q 'white.hdr: 100 % of the object is burnt out' "$scratch/stderr" || complain "no word of it: $(cat "$scratch/stderr")"
[ -z "$(estimate white.hdr "${small[@]}" --quiet 2>&1)" ] || complain "--quiet was not"
succeeds '"burnt_out":0,' estimate disc.hdr "${small[@]}" --json
! grep -q 'burnt out' "$scratch/stderr" || complain "a photograph that is not was called burnt out"

echo "a photograph that the model does not know gets a word, one that it knows none"
succeeds '"code":"object_small","message":"the object has 1513 pixels' estimate disc.hdr "${small[@]}" --json
[ "$(wc -l <"$scratch/stderr")" -eq 1 ] || complain "more than a line of doubts: $(cat "$scratch/stderr")"
grep -q '"drawing"' out.merlin/report.json || complain "report.json does not say that a disc of one colour is a drawing"
MERLIN_MODEL='' succeeds '"warnings":\[\]' estimate "$MERLIN_SOURCE_DIR/examples/demo.png" -o demo --size 256 --views 1 --json
[ ! -s "$scratch/stderr" ] || complain "of a good photograph it said: $(cat "$scratch/stderr")"
rm -rf out.merlin white.hdr

echo "a name that is not UTF-8 leaves the JSON valid"
cp disc.hdr $'d\351sc\303\251\355\240\200.hdr'
succeeds $'"input":"d\357\277\275sc\303\251\357\277\275\357\277\275\357\277\275.hdr"' estimate d*c*.hdr --size 64 -o named --json
rm -r d*sc?*.hdr named

echo "--mesh adds the front as a mesh"
succeeds disc.merlin/overview.png estimate disc.hdr --size 64 --mesh
succeeds '"disc.merlin/mesh.glb"' estimate disc.hdr --size 64 --mesh --json
[ "$(head -c 4 disc.merlin/mesh.glb)" = glTF ] || complain "mesh.glb is none"
reads_mesh disc.merlin/mesh.glb

echo "files of an earlier run that this one does not write get a word"
succeeds '"warnings":\[.*"code":"files_left","message":"mesh.glb in disc.merlin is not of this run, and may show another object: write it anew, or remove it"' \
    estimate disc.hdr --size 64 --json
mkdir disc.merlin/relit
succeeds disc.merlin estimate disc.hdr --size 64
grep -q 'mesh.glb, relit in disc.merlin are not of this run' "$scratch/stderr" || complain "no word: $(cat "$scratch/stderr")"
rm -r disc.merlin/relit disc.merlin/mesh.glb
succeeds disc.merlin estimate disc.hdr --size 64
grep 'this run' "$scratch/stderr" && complain "a word of nothing"

echo "masks are used, and must fit"
refuses 1 'cannot write disc.merlin/mask.png: it is what was read; copy it' estimate disc.hdr --mask disc.merlin/mask.png --size 64 -o disc.merlin
succeeds '"mask":"given"' estimate disc.hdr --mask disc.merlin/mask.png "${small[@]}" --json
rm -rf out.merlin
radiance large.hdr 80 30
refuses 1 'the mask is 64×64 pixels, the photograph 80×80' estimate large.hdr --mask disc.merlin/mask.png "${small[@]}"
radiance empty.hdr 64 0
refuses 1 'mask selects nothing (0 pixels are half white' estimate disc.hdr --mask empty.hdr "${small[@]}"
refuses 2 '--mask wants a value' estimate disc.hdr --mask '' "${small[@]}"
mkfifo pipe
refuses 1 'pipe: it is not a plain file' estimate pipe "${small[@]}"
refuses 1 'pipe' estimate disc.hdr --model pipe
refuses 1 'no object stands out' estimate empty.hdr "${small[@]}"
refuses 1 'missing.png' estimate disc.hdr --mask missing.png "${small[@]}"
openexr black.exr '\0\0\0\0'
radiance round.hdr 16 6
refuses 1 'black.exr: the object is black' estimate black.exr --mask round.hdr "${small[@]}"
mkdir beside
cp disc.merlin/albedo.png beside/a.png
cp disc.merlin/albedo.png beside/b.png
cp disc.merlin/mask.png beside/a.mask.png
refuses 1 'no mask for beside/b.png in beside' estimate beside/a.png beside/b.png --mask beside "${small[@]}"
absent out.merlin

echo "wrong use"
refuses 2 'no photograph' estimate
refuses 2 'unknown option' estimate disc.hdr --nonsense
refuses 1 'no weights file merlin-nowhere' estimate disc.hdr --model merlin-nowhere
refuses 2 'multiple of 32' estimate disc.hdr --size 100
refuses 2 '--size' estimate disc.hdr --size huge
refuses 2 '--size' estimate disc.hdr --size 1024
refuses 2 '--exposure' estimate disc.hdr --exposure nan
refuses 2 '--views' estimate disc.hdr --views 9
refuses 2 '--mask' estimate disc.hdr large.hdr --mask disc.merlin/mask.png

echo "photographs that are none"
refuses 1 'missing.png' estimate missing.png "${small[@]}"
: >nothing.png
refuses 1 'nothing.png' estimate nothing.png "${small[@]}"
head -c 3000 disc.hdr >cut.hdr
refuses 1 'cut.hdr' estimate cut.hdr "${small[@]}"
head -c 1000 disc.merlin/normal.png >cut.png
refuses 1 'cut.png' estimate cut.png "${small[@]}"
echo "not a picture" >text.png
refuses 1 'text.png' estimate text.png "${small[@]}"
radiance one.hdr 1 1
refuses 1 '1×1' estimate one.hdr "${small[@]}"
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 20000\n' >huge.hdr
refuses 1 'huge.hdr' estimate huge.hdr "${small[@]}"
openexr nan.exr '\0\0\300\177'
refuses 1 'nan.exr' estimate nan.exr "${small[@]}"
openexr infinite.exr '\0\0\200\177'
refuses 1 'infinite.exr' estimate infinite.exr "${small[@]}"
openexr even.exr '\0\0\0\77'
refuses 1 'no object stands out' estimate even.exr "${small[@]}"
mkdir no-photos
refuses 1 'no photographs' estimate no-photos "${small[@]}"
absent out.merlin

echo "weights that are none"
refuses 1 'missing.safetensors' estimate disc.hdr --model missing.safetensors "${small[@]}"
for bad in empty truncated stub text altered; do
    refuses 1 "$bad.safetensors" estimate disc.hdr --model $bad.safetensors "${small[@]}"
done
header='{"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}}'
printf "\\x$(printf %x ${#header})"'\0\0\0\0\0\0\0%s\0\0\0\0' "$header" >other.safetensors
refuses 1 'other.safetensors' estimate disc.hdr --model other.safetensors "${small[@]}"
mkdir merlin-nowhere # of what such weights found, say
refuses 1 'there is no weights file merlin-nowhere' estimate disc.hdr --model merlin-nowhere "${small[@]}"
absent out.merlin

echo "places that cannot be written"
refuses 1 '/proc/merlin' estimate disc.hdr --size 64 -o /proc/merlin
echo >file
refuses 1 'file' estimate disc.hdr --size 64 -o file
mkdir -p taken/albedo.png
refuses 1 'taken/albedo.png' estimate disc.hdr --size 64 -o taken
[ "$(ls -A taken)" = albedo.png ] || complain "taken has $(ls -A taken)"
mkdir -p mesh/mesh.glb
refuses 1 'mesh/mesh.glb: a folder is in the way' estimate disc.hdr --size 64 --mesh -o mesh
[ "$(ls -A mesh)" = mesh.glb ] || complain "mesh has $(ls -A mesh)"

echo "a disk that fills up leaves nothing"
for blocks in 1 8 24; do
    refuses 1 'cannot write' limited $blocks "$MERLIN" estimate disc.hdr --size 64 --mesh -o full.merlin
    absent full.merlin
done

echo "what is read is not replaced"
mkdir own
cp disc.hdr own/albedo.png # by its content a Radiance picture
refuses 1 'own: its albedo.png is no earlier result' estimate own/albedo.png --size 64 -o own
cp disc.merlin/report.json own
refuses 1 'own/albedo.png: it is what was read' estimate own/albedo.png --size 64 -o own
cmp -s disc.hdr own/albedo.png || complain "the photograph was replaced"
cp disc.merlin/mask.png own
refuses 1 'own/mask.png: it is what was read' estimate disc.hdr --mask own/mask.png --size 64 -o own/../own
[ "$(ls -A own | tr '\n' ' ')" = 'albedo.png mask.png report.json ' ] || complain "own has $(ls -A own)"

echo "a batch goes on after a failure and says so"
mkdir batch
cp disc.hdr batch/a.hdr
cp disc.hdr batch/c.hdr
cp disc.merlin/mask.png batch/c.mask.png
echo "not a picture" >batch/b.png
estimate batch --size 64 -o results >out 2>err && complain "a batch with a failure succeeded"
[ "$(grep -c 'cannot read' err)" -eq 1 ] && grep -q 'cannot read.*b.png' err || complain "a batch with a failure said: $(head -3 err)"
present results/a/maps.exr results/c/maps.exr
absent results/b results/c.mask
grep -q '"given"' results/c/report.json || complain "NAME.mask.png was not used in a folder"

echo "photographs of one name in one folder have a folder each, however it is spelled"
mkdir twins
cp disc.hdr twins/disc.png # by its content a Radiance picture
cp disc.hdr twins
succeeds '^twins/../twins/disc.hdr: twins/../twins/disc-2.merlin/' estimate twins/disc.png twins/../twins/disc.hdr --size 64
cd twins || exit 1
succeeds '^./disc.hdr: ./disc-2.merlin/' estimate disc.png ./disc.hdr --size 64
cd ..
rm -r twins

echo "what a camera made of a raw picture is not taken beside it"
mkdir camera
cp disc.hdr camera/one.NEF # by its content a Radiance picture
cp disc.hdr camera/one.jpg
cp disc.hdr camera/two.jpg
succeeds '^camera/one.NEF: ' estimate camera --size 64
[ "$(ls -d camera/*.merlin | tr '\n' ' ')" = "camera/one.merlin camera/two.merlin " ] || complain "beside a raw picture: $(ls camera)"
rm -r camera

echo "in a folder a mask goes before the photograph's alpha, as the help says"
mkdir cut
cp "$MERLIN_SOURCE_DIR/examples/demo.png" cut
cp disc.merlin/mask.png cut/demo.mask.png # of another size, to be told of
refuses 1 'the mask is 64×64 pixels, the photograph 512×512' estimate cut "${small[@]}"
succeeds "picture's kind, else the photograph's alpha, else" estimate --help
rm -r cut

echo "a mask has any usual name, beside a photograph, in its folder and in a folder of masks"
mkdir named masks
cp disc.hdr named/cup.hdr
for mask in cup.mask.png CUP_mask.PNG cup-mask.tif mask_cup.png cup.hdr.mask.jpg cup_alpha.png; do
    cp disc.merlin/mask.png "named/$mask"
    for what in named/cup.hdr named "named/$mask named/cup.hdr"; do
        # shellcheck disable=SC2086
        succeeds "\"mask\":\"given\".*\"mask_file\":\"named/$mask\"" estimate $what --json "${small[@]}"
        [ "$(wc -l <"$scratch/stdout")" = 1 ] || complain "$mask was taken for a photograph"
        grep skipped "$scratch/stderr" && complain "$mask is used, but called skipped"
        rm -rf out.merlin
    done
    mv "named/$mask" "masks/$mask"
    succeeds "\"mask_file\":\"masks/$mask\"" estimate named --mask masks --json "${small[@]}"
    rm "masks/$mask"
done
for mask in cup.PNG CUP.png cup.hdr.png Mask.png; do
    cp disc.merlin/mask.png "masks/$mask"
    succeeds "\"mask_file\":\"masks/$mask\"" estimate named --mask masks --json "${small[@]}"
    rm "masks/$mask"
done
refuses 1 'no mask for named/cup.hdr in masks: looked for cup.mask.png, cup_mask.png, .*, cup.png, cup.hdr.png' \
    estimate named --mask masks --json "${small[@]}"
cp disc.merlin/mask.png named/MASK.png
succeeds '"mask_file":"named/MASK.png"' estimate named --json "${small[@]}"
cp disc.hdr named/dog.hdr
succeeds '"mask":"found".*"file":"named/MASK.png","why":"a mask, but of which photograph' estimate named --json "${small[@]}"
grep -q 'named: 1 file skipped: MASK.png (' "$scratch/stderr" || complain "MASK.png is skipped without a word"
rm -r named masks out.merlin

echo "--mesh takes a name, or none"
mkdir meshes-named
cp disc.hdr meshes-named/disc.hdr
cd meshes-named || exit 1
succeeds '"files":\["./a.glb","./a.mtl","./a.obj","./a.ply","./a.png","out.merlin/albedo.png"' estimate --mesh a.obj --mesh a.ply disc.hdr --mesh=a.glb --json "${small[@]}"
present a.obj a.mtl a.png a.ply a.glb out.merlin/maps.exr
absent out.merlin/mesh.glb
reads_mesh a.obj
reads_mesh a.ply
succeeds 'disc.hdr' estimate --mesh disc.hdr "${small[@]}"
present out.merlin/mesh.glb
rm -rf out.merlin
succeeds 'disc.hdr' estimate . "${small[@]}"
grep -q "5 files skipped: a.glb, a.mtl, a.obj, a.ply (no picture), a.png (a mesh's texture)" "$scratch/stderr" || complain "a mesh's texture: $(head -1 "$scratch/stderr")"
rm -r out.merlin a.*
succeeds '"files":\["./a.png","./a.usda","./a_normal.png","./a_roughness.png","out.merlin/albedo.png"' estimate --mesh a.usda disc.hdr --json "${small[@]}"
succeeds 'disc.hdr' estimate . "${small[@]}"
grep -q "4 files skipped: a.png, a_normal.png, a_roughness.png (a mesh's texture), a.usda (no picture)" "$scratch/stderr" ||
    complain "textures of USD: $(head -1 "$scratch/stderr")"
rm -r out.merlin a.* a_*
for other in a.obj:a.png a.obj:a.mtl a.usda:a.png a.usda:a_normal.png a.usda:a_roughness.png; do
    echo mine >"${other#*:}"
    refuses 1 "${other%:*}: ${other#*:} is no part of an earlier one" estimate disc.hdr --mesh "${other%:*}" "${small[@]}"
    [ "$(cat "${other#*:}")" = mine ] || complain "${other#*:} was replaced"
    absent out.merlin "${other%:*}"
    rm a*
done
for mesh in a.obj a.usda a.obj; do succeeds 'disc.hdr' estimate disc.hdr --mesh $mesh "${small[@]}"; done # share a.png
rm -r out.merlin a.* a_*
refuses 1 "its texture would replace the map normal.png" estimate disc.hdr --mesh out.merlin/normal.usda "${small[@]}"
refuses 2 'a mesh.s name ends in' estimate disc.hdr --mesh a.stl
refuses 2 'one photograph' estimate disc.hdr disc.hdr --mesh a.obj
refuses 2 'one photograph' estimate . --mesh a.obj
refuses 2 '--mesh wants a value' estimate disc.hdr --mesh=
cp disc.hdr disc.png # by its content a Radiance picture
refuses 1 'disc.png: it is what was read' estimate disc.png --mesh disc.obj "${small[@]}"
refuses 1 'no-folder' estimate disc.hdr --mesh /dev/null/no-folder/a.obj "${small[@]}"
absent out.merlin a.obj disc.obj
cd ..
rm -r meshes-named

echo "the other commands that take a photograph find its mask, too"
mkdir other
cp disc.hdr other/cup.hdr
radiance other/cup_mask.hdr 16 6
refuses 1 'the mask is 16×16 pixels, the photograph 64×64' "$MERLIN" stereo other/cup.hdr --size 64 --model weights.safetensors
refuses 1 'the mask is 16×16 pixels, the photograph 64×64' "$MERLIN" relight other/cup.hdr --light 0,0,0 --model weights.safetensors
refuses 1 'the mask is 16×16 pixels, the photograph 64×64' estimate other/cup.hdr --size 64
rm -r other

echo "a folder's photographs are told by content, and what is skipped is counted and named"
mkdir mixed
cp disc.hdr mixed/one.jfif
cp disc.hdr mixed/two
echo "no picture" >mixed/notes.txt
echo "no picture" >mixed/Thumbs.db
echo "no picture" >mixed/two.xmp
printf '\377\012 and more' >mixed/three.jxl
succeeds 'mixed/two: results/two/' estimate mixed --size 64 -o results
[ "$(head -1 "$scratch/stderr")" = "merlin estimate: mixed: 2 files skipped: notes.txt (no picture), three.jxl (JPEG XL is not read)" ] ||
    complain "of a mixed folder it said: $(cat "$scratch/stderr")"
succeeds '"code":"files_skipped".*"file":"mixed/three.jxl","why":"JPEG XL is not read"' estimate mixed --size 64 -o results --json
[ "$(grep -c files_skipped "$scratch/stdout")" = 1 ] || complain "skipped files are told more than once"
mkdir -p mixed/more mixed/one.merlin mixed/masks
cp disc.hdr mixed/more
cp disc.hdr mixed/one.merlin/maps.exr
cp disc.merlin/mask.png mixed/masks/one.png
cp disc.merlin/mask.png mixed/masks/two.png
succeeds 'mixed/two: ' estimate mixed --mask mixed/masks --size 64 -o results
[ "$(head -1 "$scratch/stderr")" = "merlin estimate: mixed: 3 files skipped: notes.txt (no picture), three.jxl (JPEG XL is not read), more/ (a folder of its own)" ] ||
    complain "of a mixed folder with folders it said: $(head -1 "$scratch/stderr")"
rm -r mixed/more mixed/one.merlin mixed/masks
estimate mixed --size 64 -o results --quiet 2>err
[ -s err ] && complain "it is not quiet: $(cat err)"
rm mixed/one.jfif mixed/two
refuses 1 'no photographs in the folder mixed: 2 files skipped: notes.txt (no picture), three.jxl' estimate mixed --size 64
rm -r mixed

echo "what was made of photographs is not taken for photographs the next time"
mkdir again
cp disc.hdr again/a.hdr
cp disc.hdr again/b.hdr
for _ in 1 2; do succeeds 'again/b.merlin/overview.png' estimate again/* --size 64; done
[ "$(ls again again/a.merlin | tr '\n' ' ')" = "again: a.hdr a.merlin b.hdr b.merlin  again/a.merlin: $names " ] ||
    complain "there is $(ls again again/a.merlin)"
refuses 1 'no photographs, but maps .* in the folder again/a.merlin' estimate again/a.merlin --size 64
succeeds 'again/a.hdr' estimate again/a.hdr --size 64 -o again
succeeds 'again/b.hdr' estimate again --size 64
absent again/albedo.merlin again/maps.merlin
rm -r again

echo "a batch is shared, and goes on where it was"
mkdir shares
for name in a b c; do cp disc.hdr "shares/$name.hdr"; done
cp disc.hdr shares/a.rgbe.hdr
estimate shares --size 64 -o shared --share 1/2 >out 2>err || complain "a share fails: $(cat err)"
[ "$(ls shared | tr '\n' ' ')" = "a b " ] || complain "the first of two shares of four is $(ls shared)"
estimate shares --size 64 -o shared --resume >out 2>err || complain "a batch does not go on: $(cat err)"
[ "$(ls shared | tr '\n' ' ')" = "a a.rgbe b c " ] && [ "$(wc -l <out)" -eq 2 ] || complain "not the rest but $(cat out)"
grep -q "2 of 4 photographs have their maps" err || complain "what was there is not told: $(cat err)"
touch -d "1 hour" shares/b.hdr
estimate shares --size 64 -o shared -r >out 2>err || complain "a changed photograph is not taken again: $(cat err)"
grep -q "^shares/b.hdr" out && [ "$(wc -l <out)" -eq 1 ] || complain "not the changed one alone but $(cat out)"
for other in '--size 96' '--size 96 --model merlin-any' '--size 96 --fov 30' '--size 96 --fov 30 --flash' '--size 96 --views 1 --exposure 1'; do
    # shellcheck disable=SC2086 # each is several options
    estimate shares $other -o shared -r --share 2/2 >out 2>err || complain "$other: does not go on: $(cat err)"
    [ "$(wc -l <out)" -eq 2 ] || complain "maps by other options than $other are kept: $(cat out err)"
    # shellcheck disable=SC2086
    estimate shares $other -o shared -r --share 2/2 >out 2>err || complain "$other: does not go on: $(cat err)"
    [ -s out ] && complain "$other: its maps are made again: $(cat out)"
done
for wrong in 0/2 3/2 1 1/0 a/b -1/2 1/2x; do refuses 2 "wants K/N" estimate shares --share="$wrong"; done
rm -r shares shared

echo "a batch that goes on takes no other photograph's maps, and lacks no file that is asked for"
mkdir shares
cp disc.hdr shares/a.hdr
estimate shares --size 64 -o shared -q || complain "a photograph fails"
mv shares/a.hdr shares/b.hdr
cp disc.merlin/reconstruction.png shares/a.png
touch -d "-1 hour" shares/*
estimate shares --size 64 -o shared -r >out 2>err || complain "a batch of other names fails: $(cat err)"
grep -q '^shares/a.png: shared/a/' out && grep -q '^shares/b.hdr: shared/b/' out ||
    complain "a.png has the maps of what was a.hdr: $(cat out err)"
estimate shares --size 64 -o shared -r >out 2>err && [ ! -s out ] || complain "what is done is done again: $(cat out err)"
estimate shares --size 64 -o shared -r --mesh --html >out 2>err || complain "more files fail: $(cat err)"
[ -s shared/a/mesh.glb ] && [ -s shared/b/viewer.html ] || complain "files that were asked for are missing: $(cat err)"
cp shared/b/mask.png shares/b.mask.png
touch -d "-1 hour" shares/b.mask.png
estimate shares --size 64 -o shared -r >out 2>err || complain "a new mask fails: $(cat err)"
grep -q "^shares/b.hdr" out && [ "$(wc -l <out)" -eq 1 ] || complain "a mask that is new, but older, is ignored: $(cat out)"
rm -r shares shared

echo "an interrupted batch stops and leaves nothing half written"
mkdir many
for i in {100..199}; do ln disc.hdr "many/$i.hdr"; done
"$MERLIN" estimate many --size 64 -o interrupted --json >out 2>err &
pid=$!
await interrupted/101/report.json
grep -q '"input":"many/100.hdr".*}$' out || complain "the first report of a batch waits for others: $(cat out)"
kill -INT $pid
wait $pid
code=$?
[ $code -eq 1 ] || complain "exit code $code after an interrupt"
[ "$(grep -vc '^merlin estimate: many/1[0-9]*.hdr: ' err)" -eq 1 ] || complain "after an interrupt: $(cat err)"
grep -q interrupted err || complain "after an interrupt: $(cat err)"
for folder in interrupted/*; do
    [ "$(ls -A "$folder" | sort | tr '\n' ' ')" = "$names " ] || complain "$folder has $(ls -A "$folder")"
done

if [ -z "$(trap -p HUP)" ]; then # else this was started by nohup
    echo "one whose terminal is closed does, too"
    "$MERLIN" estimate many --size 64 -o closed >out 2>err &
    pid=$!
    await closed/100/report.json
    kill -HUP $pid
    wait $pid
    code=$?
    [ $code -eq 1 ] && grep -q interrupted err || complain "exit code $code when a terminal is closed: $(cat err)"
    [ -z "$(find closed -name '.*')" ] || complain "a closed terminal leaves $(find closed -name '.*')"
    (trap '' HUP && exec "$MERLIN" estimate many/10?.hdr --size 64 -o on --quiet) &
    pid=$!
    await on/100/report.json
    kill -HUP $pid
    wait $pid || complain "nohup does not keep it"
    present on/109/report.json
fi
finish
