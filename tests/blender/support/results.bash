# SPDX-License-Identifier: MIT
# Results of merlin for the tests of the Blender add-on.
#
#     make_results FOLDER        a folder for each, and in FOLDER/relit what merlin makes of them under other light

# wide_picture IN OUT: the demonstration picture at a quarter's size, at the upper left in a wide one, by Blender.
wide_picture() {
    "$BLENDER" -b --factory-startup --python-exit-code 1 --python "$support/wide_picture.py" -- "$1" "$2" >"$scratch/said" 2>&1 ||
        complain "no wide picture: $(tail -3 "$scratch/said")"
}

# made COMMAND...: merlin, quickly.
made() { "$MERLIN" "$@" -q 2>"$scratch/stderr" || complain "merlin $* exited with $?: $(cat "$scratch/stderr")"; }

make_results() {
    local to=$1 examples=$MERLIN_SOURCE_DIR/examples quick=(--size 256 --views 1)
    mkdir -p "$to/relit"
    wide_picture "$examples/demo.png" "$to/wide.png"
    made estimate "$examples/demo.png" "${quick[@]}" --mesh "$to/demo.ply" -o "$to/demo"
    made estimate "$to/wide.png" "${quick[@]}" --fov 70 --mesh "$to/slanted.ply" -o "$to/slanted"
    made estimate "$to/wide.png" "${quick[@]}" --mesh "$to/shifted.ply" -o "$to/shifted"
    made estimate "$examples/window.png" "${quick[@]}" --model merlin-any -o "$to/window"
    made estimate "$examples/demo.png" "${quick[@]}" --model merlin-env -o "$to/room"
    made relight "$to/demo" --dome 12 --lp -o "$to/dome"
    made stereo "$to/dome" -o "$to/far"
    made stereo "$to/demo" -o "$to/near"
    made relight "$to/demo" --light 0,0,0 -o "$to/relit/flash"
    made relight "$to/demo" --light 0.7,0.3,-0.4 -o "$to/relit/lamp"
    made relight "$to/slanted" --light 0,0,0 -o "$to/relit/slanted"
    made relight "$to/window" --found-light -o "$to/relit/window"
    made relight "$to/far" --direction -1,1,1.5 --exposure 0 -o "$to/relit/far"
}
