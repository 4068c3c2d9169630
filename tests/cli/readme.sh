#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The commands that README.md and the pages behind it print do what they say, and the programs of docs/library.md build and run.
# What a reader brings along (photo.jpg, room.hdr, pictures of a ball and of an object) is made here.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
unset MERLIN_MODEL
build=$(dirname "$MERLIN")
docs=$MERLIN_SOURCE_DIR/docs
if sanitized; then
    echo "skipped: under a sanitizer they take minutes; each has a test of its own"
    exit 77
fi
cd "$scratch" || exit 1
mkdir -p build/release
ln -s "$(realpath "$MERLIN")" build/release/merlin
[[ -z ${MERLIN_LAB:-} ]] || ln -s "$(realpath "$MERLIN_LAB")" build/release/merlin-lab
for name in configs examples models; do ln -s "$MERLIN_SOURCE_DIR/$name" .; done

# ---- what a reader brings along ----

# reflection X Y Z: a picture of a mirror ball, 50 pixels in radius, in a light from there.
reflection() {
    awk -v x="$1" -v y="$2" -v z="$3" 'BEGIN {
        length_of = sqrt(x * x + y * y + z * z)
        x /= length_of; y /= length_of; z = z / length_of + 1 # the normal is halfway to the camera
        length_of = sqrt(x * x + y * y + z * z)
        u = 64 + 50 * x / length_of; v = 64 - 50 * y / length_of
        print "P2 128 128 255"
        for (j = 0; j < 128; j++) for (i = 0; i < 128; i++) print ((i + 0.5 - u) ^ 2 + (j + 0.5 - v) ^ 2 < 9 ? 255 : 3)
    }'
}

# take_pictures: of an object and of a ball in 20 lights, from the maps that the first commands have made.
take_pictures() {
    "$MERLIN" relight photo.merlin --dome 20 --lp -o capture -q || complain "no pictures of an object"
    mkdir ball
    awk 'BEGIN { print "P2 128 128 1"
        for (j = 0; j < 128; j++) for (i = 0; i < 128; i++) print ((i - 63.5) ^ 2 + (j - 63.5) ^ 2 < 2500) }' >ball/mask.png
    while read -r name x y z; do reflection "$x" "$y" "$z" >"ball/$name"; done < <(tail -n +2 capture/dome.lp)
    mv capture/dome.lp .
    "$PICTURES_VIDEO" clip.mp4 2 capture/dome_*.png || echo "skipped: there is no FFmpeg for a video"
    local light
    for light in left top right; do ln -s capture/dome_00${#light}.png $light.jpg; done
}

# ---- what it prints ----

# blocks PAGE: its code, without remarks.
blocks() { awk 'sub(/^    /, "") { sub(/  +# .*/, ""); print }' "$1"; }

try() { bash -c "$1" >stdout 2>stderr </dev/null || complain "$1 exited with $?: $(cat stderr)"; }

# run COMMAND: as it is printed, but for what needs a network or hours.
run() {
    case $1 in
    sudo\ apt-get*) ;;
    "make demo") try "make -C '$MERLIN_SOURCE_DIR' -o build demo MERLIN='$PWD/build/release/merlin' OUT='$PWD/out/demo'" ;;
    build/release/merlin-lab\ render*) try "$(sed -E 's/--count [0-9]+/--count 2/; s/--size [0-9]+/--size 64/' <<<"$1")" ;;
    build/release/merlin-lab\ train*)
        [ -e "$(cut -d ' ' -f 3 <<<"$1")" ] || complain "there are no settings for $1"
        try "$1 --help" # what is wrong with the options is told before the help
        ;;
    build/release/merlin\ stereo\ clip.mp4*) [ ! -e clip.mp4 ] || try "$1" ;;
    build/release/merlin\ * | build/release/merlin-lab\ * | cat\ *) try "$1" ;;
    *) complain "it prints a command that is not tried here: $1" ;;
    esac
}

# run_all PAGE PATTERN: those of its commands that have it; there must be some.
run_all() {
    local commands
    mapfile -t commands < <(blocks "$1" | grep -E "$2")
    ((${#commands[@]} > 0)) || complain "nothing is printed of $2 under $1"
    for command in "${commands[@]}"; do run "$command"; done
}

echo "the demonstration"
run_all "$MERLIN_SOURCE_DIR/README.md" '^(sudo|make)'
present out/demo/{overview.png,orbit/orbit.webp,mesh.glb}

echo "a picture of one's own"
cp examples/demo.png photo.jpg
radiance room.hdr 32 6 64
run_all "$MERLIN_SOURCE_DIR/README.md" 'merlin (estimate|view|relight (photo.merlin|window))'
run_all "$docs/photographs.md" .
present photo.merlin/relit/{relit.png,orbit.png,orbit.webp} lit.jpg window/relit/relit.png dome/dome_049.png dome/dome.lp
mapfile -t files < <(awk '/^## / { on = $0 == "## Output" } on && match($0, /^\| `[a-z.]*`/) { print substr($0, 4, RLENGTH - 4) }' "$docs/photographs.md")
((${#files[@]} > 8)) || complain "the table of files has only ${files[*]}"
present "${files[@]/#/photo.merlin/}"

echo "many lights"
take_pictures
run_all "$MERLIN_SOURCE_DIR/README.md" 'merlin (stereo|relight surface)'
run_all "$docs/captures.md" .
run_all "$docs/viewer.md" .
present lights/lights.txt surface/{mesh.glb,mesh.ply,mesh.obj,overview.png,error.png} surface/relit/relit.png
present photo.merlin/stereo/mesh.glb photo.merlin/viewer.html owl.html
paste -d ' ' <(tail -n +2 dome.lp) <(grep -v '^#' lights/lights.txt) |
    awk '{ if ($2 * $5 + $3 * $6 + $4 * $7 < 0.9986) exit 1; n++ } END { if (n != 20) exit 1 }' ||
    complain "the ball's lights are not within three degrees: $(cat lights/lights.txt)"

if [[ -n ${MERLIN_LAB:-} ]]; then
    echo "training"
    mkdir -p runs/256
    ln -s "$MERLIN_SOURCE_DIR/models/merlin-point.safetensors" runs/256/weights.safetensors
    run_all "$docs/training.md" .
    present data/{train,train256,heldout}/000000.exr
fi

echo "the library"
cmake --install "$build" --prefix "$scratch/prefix" >install.log || complain "it does not install: $(cat install.log)"
description=(prefix/lib*/pkgconfig)
export PKG_CONFIG_PATH=$PWD/${description[0]} LD_LIBRARY_PATH=$PWD/${description[0]%/*}
mv dome owl
# Every program begins with the headers; where a call goes wrong it says so.
blocks "$docs/library.md" | awk '/^#include </ && !head { number++ } { head = /^#include </ }
    { print > (("program" number) (head ? ".h" : ".body")) }'
for head in program*.h; do
    number=${head//[!0-9]/}
    {
        printf '#include <stdio.h>\n'
        cat program$number.h
        printf 'int main(void)\n{\n'
        sed -E '/_(free|close)\(/!s/^(merlin_[a-z_]+\(.*\));$/if (\1 != 0) { puts(merlin_error()); return 1; }/' program$number.body
        printf 'return 0;\n}\n'
    } >program$number.c
    # shellcheck disable=SC2046
    cc program$number.c $(pkg-config --cflags --libs merlin) -o program$number 2>stderr || complain "program $number: $(cat stderr)"
    ./program$number >stdout 2>&1 || complain "program $number: $(cat stdout)"
done
present relit.png cup.glb cup.html

finish
