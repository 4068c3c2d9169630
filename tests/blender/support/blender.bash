# SPDX-License-Identifier: MIT
# Blender for the tests of the add-on: its settings are in $scratch, nobody's own are touched. BLENDER names another one.
#
#     needs_blender; pack_addon; in_blender check_results.py "$scratch/merlin-blender.zip" ...

export BLENDER=${BLENDER:-blender} OMP_WAIT_POLICY=passive
export BLENDER_USER_CONFIG=$scratch/blender/config BLENDER_USER_SCRIPTS=$scratch/blender/scripts
export BLENDER_USER_RESOURCES=$scratch/blender BLENDER_USER_EXTENSIONS=$scratch/blender/extensions
export TMPDIR=$scratch PYTHONDONTWRITEBYTECODE=1 # nothing is left behind
unset MERLIN_MODEL

# needs_blender: without it, and where merlin would take minutes, the test is skipped.
needs_blender() {
    mkdir -p "$BLENDER_USER_CONFIG" "$BLENDER_USER_SCRIPTS" "$BLENDER_USER_EXTENSIONS"
    if ! command -v "$BLENDER" >/dev/null; then
        echo "skipped: there is no Blender (apt-get install blender)"
        exit 77
    fi
    if ! "$BLENDER" -b --factory-startup --python-exit-code 1 --python-expr 'import numpy' >/dev/null 2>&1; then
        echo "skipped: Blender's Python has no numpy (apt-get install python3-numpy)"
        exit 77
    fi
    if sanitized; then
        echo "skipped: the add-on calls a program, which has tests of its own under a sanitizer"
        exit 77
    fi
}

pack_addon() { "$MERLIN_SOURCE_DIR/tools/pack-blender" "$scratch/merlin-blender.zip" || complain "no zip was packed"; }

# told STATUS SCRIPT: shows what the checks of a script said, all of it if one has failed.
told() {
    grep -E '^\[|passed,|% of white' "$scratch/said"
    [[ $1 == 0 ]] && grep -q 'passed, 0 failed' "$scratch/said" || complain "$2 exited with $1: $(cat "$scratch/said")"
}

# in_blender SCRIPT ARGUMENT...: without a window.
in_blender() {
    local status=0
    "$BLENDER" -b --factory-startup --python-exit-code 1 --python "$support/$1" -- "${@:2}" >"$scratch/said" 2>&1 || status=$?
    told $status "$1"
}

# show_blender SCRIPT ARGUMENT...: in one, drawn by the processor.
show_blender() {
    local status=0
    LIBGL_ALWAYS_SOFTWARE=1 timeout 300 xvfb-run -a -s "-screen 0 640x480x24" "$BLENDER" --factory-startup -noaudio \
        --enable-event-simulate --window-geometry 0 0 640 480 --python-exit-code 1 --python "$support/$1" -- "${@:2}" \
        >"$scratch/said" 2>&1 || status=$?
    told $status "$1"
}
