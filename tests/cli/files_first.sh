#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What is not there, or cannot be written, is told before weights are read; "-" is a photograph from standard input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
make_tiny_model
make_bad_weights
cd "$scratch" || exit 1
radiance disc.hdr 64 22
radiance other.hdr 64 22
echo "no folder" >file

echo "damaged weights are not what is complained of where a file is missing"
bad=(--model truncated.safetensors)
refuses 1 "there is no photograph missing.png" "$MERLIN" estimate missing.png "${bad[@]}"
refuses 1 "there is no mask missing.png" "$MERLIN" estimate disc.hdr --mask missing.png "${bad[@]}"
refuses 1 "cannot make the folder file" "$MERLIN" estimate disc.hdr -o file/maps "${bad[@]}"
refuses 1 "there is no photograph or folder missing.png" "$MERLIN" relight missing.png --light 0,0,0 "${bad[@]}"
refuses 1 "there is no mask missing.png" "$MERLIN" relight disc.hdr --light 0,0,0 --mask missing.png "${bad[@]}"
refuses 1 "missing.txt" "$MERLIN" relight disc.hdr --lights missing.txt "${bad[@]}"
refuses 1 "missing.hdr" "$MERLIN" relight disc.hdr --env missing.hdr "${bad[@]}"
refuses 1 "cannot make the folder file" "$MERLIN" relight disc.hdr --light 0,0,0 -o file/relit "${bad[@]}"
refuses 1 "there is no folder or photograph missing.png" "$MERLIN" stereo missing.png "${bad[@]}"
refuses 1 "there is no mask missing.png" "$MERLIN" stereo disc.hdr --mask missing.png "${bad[@]}"
refuses 1 "cannot make the folder file" "$MERLIN" stereo disc.hdr -o file/surface "${bad[@]}"
refuses 1 "truncated.safetensors" "$MERLIN" estimate disc.hdr -o new/maps "${bad[@]}"
absent new

mkdir taken
printf "" >taken/000000.exr
refuses 1 "or give --method universal or uncalibrated" "$MERLIN" stereo taken --method robust

echo "a batch goes on after a photograph that is missing, the first one included"
"$MERLIN" estimate missing.png disc.hdr missing2.png -q -o batch --model weights.safetensors >out 2>errors
[[ $? == 1 && $(grep -c "there is no photograph" errors) == 2 ]] || complain "two missing photographs: $(cat errors)"
present batch/disc/maps.exr
absent batch/missing batch/missing2

echo "a photograph from standard input gives the maps of the file, whatever its format"
"$MERLIN" estimate disc.hdr -q -o by-file --model weights.safetensors || complain "the file fails"
"$MERLIN" estimate - -o by-pipe --model weights.safetensors <disc.hdr >out 2>/dev/null || complain "the pipe fails"
grep -q "^standard input: by-pipe/overview.png" out || complain "it said $(cat out)"
cat disc.hdr | "$MERLIN" estimate - -o by-pipe --json -q --model weights.safetensors >out || complain "the pipe fails"
grep -q '"input":"-"' out || complain "the report names another input: $(cat out)"
for map in albedo normal depth mask; do
    cmp -s by-file/$map.png by-pipe/$map.png || complain "$map.png differs"
done
"$MERLIN" relight by-file --light 0.7,0.3,-0.4 -o - --model weights.safetensors >by-file.png || complain "no picture of maps"
cat by-file/albedo.png | "$MERLIN" relight - --mask by-file/mask.png --light 0,0,0 -o - -q --model weights.safetensors >relit.png
present by-file.png relit.png
refuses 2 "say where to by -o" "$MERLIN" estimate - <disc.hdr
refuses 2 "comes alone" "$MERLIN" estimate - disc.hdr -o batch <disc.hdr
refuses 1 "standard input is empty" "$MERLIN" estimate - -o none "${bad[@]}" </dev/null
refuses 1 "standard input" "$MERLIN" estimate - -o none --model weights.safetensors <file
grep -q "proc/self" stderr && complain "it names a path of its own: $(cat stderr)"
absent none
cp disc.hdr ./-
"$MERLIN" estimate ./- -q -o by-name --model weights.safetensors </dev/null || complain "a file called - fails"
cmp -s by-file/normal.png by-name/normal.png || complain "a file called - gives other maps"
finish
