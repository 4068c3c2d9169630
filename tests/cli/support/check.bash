# SPDX-License-Identifier: MIT
# For the scripts of this folder: a scratch folder ($scratch, removed at the end) and checks that count their failures.
#
#     source "$(dirname "$0")/check.bash"
#     succeeds "a line of its output" "$MERLIN" info weights.safetensors
#     refuses 1 "no samples" "$MERLIN_LAB" eval --data empty --model w
#     finish

set -u
: "${MERLIN:?the path of merlin}"
scratch=$(mktemp -d "${TMPDIR:-/tmp}/merlin-cli-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
failures=0

complain() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# sanitized: whether merlin was built with sanitizers, which take several times as long. They find bad accesses and undefined
# arithmetic, which other numbers on the same ways do not show again.
sanitized() { ldd "$MERLIN" 2>/dev/null | grep -q 'lib[at]san'; }

# succeeds PATTERN COMMAND...: exit status 0, and a line of standard output matches.
succeeds() {
    local pattern=$1
    shift
    if ! "$@" >"$scratch/stdout" 2>"$scratch/stderr"; then
        complain "$* exited with $?: $(cat "$scratch/stderr")"
    elif ! grep -q -e "$pattern" "$scratch/stdout"; then
        complain "$* did not say \"$pattern\" but: $(head -5 "$scratch/stdout")"
    fi
}

# refuses STATUS PATTERN COMMAND...: that exit status, one line on standard error that matches, nothing on standard output.
refuses() {
    local expected=$1 pattern=$2 got=0
    shift 2
    "$@" >"$scratch/stdout" 2>"$scratch/stderr" || got=$?
    [[ $got == "$expected" ]] || complain "$* exited with $got, not $expected: $(cat "$scratch/stderr")"
    [[ $(wc -l <"$scratch/stderr") == 1 ]] || complain "$* said other than one line: $(cat "$scratch/stderr")"
    grep -q -e "$pattern" "$scratch/stderr" || complain "$* did not say \"$pattern\" but: $(cat "$scratch/stderr")"
    [[ ! -s $scratch/stdout ]] || complain "$* wrote to standard output: $(head -2 "$scratch/stdout")"
}

# lists_its_files FOLDER NAME...: the JSON that succeeds has just got says that FOLDER is the output, these the files, and
# how many bytes they have.
lists_its_files() {
    local folder=$1 files= bytes=0
    shift
    for name in "$@"; do
        files+="${files:+,}\"$folder/$name\""
        bytes=$((bytes + $(stat -c %s "$folder/$name")))
    done
    grep -qF "\"output\":\"$folder\",\"files\":[$files],\"bytes\":$bytes," "$scratch/stdout" ||
        complain "no output $folder with files $* of $bytes bytes in: $(cat "$scratch/stdout")"
}

# Weights of a tiny model in $scratch/weights.safetensors.
make_tiny_model() {
    "$TINY_MODEL" "$scratch/weights.safetensors" || {
        echo "FAILED: no tiny model could be made" >&2
        exit 1
    }
}

# A tiny model that was trained ($scratch/tiny.json, $scratch/run, $scratch/weights.safetensors) on the four samples of
# $scratch/samples.
train_tiny_model() {
    cat >"$scratch/tiny.json" <<'JSON'
{"model": {"name": "tiny", "input_global": true, "material_decoders": 1, "feature_sharing": true,
           "gated_attention": true, "relight": "network", "global_illumination": true, "lighting": "point",
           "widths": [8, 8, 8, 8, 8], "gi_widths": [8, 8, 8, 8, 8]},
 "training": {"size": 64, "batch": 2, "presentations": 4, "learning_rate": 1e-3, "encoder_rate_scale": 0.5,
              "halve_every_epochs": 5, "warmup_steps": 1, "beta1": 0.9, "beta2": 0.999, "clip_norm": 1.0, "depth_weight": 1,
              "type": "f32", "seed": 1, "exposure_jitter": 0.1, "colour_jitter": 0.05, "memory_gib": 1,
              "validation_count": 2, "validation_steps": 0, "curve_steps": 1, "checkpoint_minutes": 5}}
JSON
    "$MERLIN_LAB" render --count 4 --size 64 --spp 1 --paths 1 --no-env --quiet -o "$scratch/samples" >/dev/null &&
        "$MERLIN_LAB" train "$scratch/tiny.json" --data "$scratch/samples" -o "$scratch/run" --quiet >/dev/null &&
        mv "$scratch/run/weights.safetensors" "$scratch" || {
        echo "FAILED: no tiny model could be made" >&2
        exit 1
    }
}

# Damaged copies of $scratch/weights.safetensors.
make_bad_weights() {
    local good=$scratch/weights.safetensors size
    size=$(stat -c %s "$good")
    : >"$scratch/empty.safetensors"
    head -c $((size / 2)) "$good" >"$scratch/truncated.safetensors"
    head -c 5 "$good" >"$scratch/stub.safetensors"
    echo "not weights at all, but long enough to hold a header" >"$scratch/text.safetensors"
    cp "$good" "$scratch/altered.safetensors"
    printf '\x42\x42\x42\x42' | dd of="$scratch/altered.safetensors" bs=1 seek=$((size - 100)) conv=notrunc status=none
}

# finish: ends the test.
finish() {
    ((failures == 0)) || {
        echo "$failures failed" >&2
        exit 1
    }
    echo "passed"
    exit 0
}
