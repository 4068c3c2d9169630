#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab train --mpi: ranks train as one process does, with the same bits in every run, killed or not.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
if ! command -v mpirun >/dev/null || [[ ! -e ${MERLIN%/*}/merlin_mpi.so ]]; then
    echo "skipped: no Open MPI here, or none when merlin was built"
    exit 77
fi
export OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_plm_rsh_agent=false OMPI_MCA_btl_vader_single_copy_mechanism=none # no ssh; containers refuse the latter
# Open MPI's plug-ins keep memory and are unloaded before the sanitizer looks, so that no name can excuse them.
unleaking=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
"$MERLIN_LAB" render --count 12 --size 64 --seed 3 --paths 1 -q -o "$scratch/samples" || complain "no samples"

# config RATE PRESENTATIONS: a run of a tiny model; a checkpoint after every step.
config() {
    cat >"$scratch/run.json" <<JSON
{"model": {"name": "tiny", "input_global": true, "material_decoders": 1, "feature_sharing": true,
           "gated_attention": true, "relight": "network", "global_illumination": true, "lighting": "point",
           "widths": [8, 8, 8, 8, 8], "gi_widths": [8, 8, 8, 8, 8]},
 "training": {"size": 64, "batch": 4, "presentations": $2, "learning_rate": $1, "encoder_rate_scale": 0.5,
              "halve_every_epochs": 40, "warmup_steps": 10, "beta1": 0.9, "beta2": 0.99, "clip_norm": 5,
              "depth_weight": 2, "type": "f32", "seed": 3, "exposure_jitter": 0.2, "colour_jitter": 0.05,
              "memory_gib": 1, "validation_count": 4, "validation_steps": 20, "curve_steps": 1,
              "average_decay": 0.99, "checkpoint_minutes": 0}}
JSON
}

# train RANKS FOLDER [OPTION]...: with no ranks, one process without MPI.
train() {
    local ranks=$1 folder=$2
    shift 2
    local command=("$MERLIN_LAB" train "$scratch/run.json" --data "$scratch/samples" -o "$scratch/$folder" --quiet)
    ((ranks == 0)) || command=(env ASAN_OPTIONS="$unleaking" mpirun --oversubscribe -n "$ranks" "${command[@]}" --mpi)
    "${command[@]}" "$@"
}

# The largest relative difference of two runs' losses, in millionths.
apart() {
    paste -d, <(cut -d, -f5 "$scratch/$1/curves.csv") <(cut -d, -f5 "$scratch/$2/curves.csv") |
        awk -F, 'NR > 1 { d = ($1 - $2) / $1; d = d < 0 ? -d : d; most = d > most ? d : most } END { printf "%d", most * 1e6 }'
}

same_run() {
    for file in checkpoint.safetensors weights.safetensors curves.csv validation.csv; do
        cmp -s "$scratch/$1/$file" "$scratch/$2/$file" || complain "$2/$file differs from $1/$file"
    done
}

# Rates so small that rounding, which grows with every step, stays below what is asked for.
config 1e-5 160
train 0 alone || complain "one process does not train"
sanitized && numbers=2 || numbers='1 2 4'
for ranks in $numbers; do
    train $ranks "of$ranks" || complain "$ranks ranks do not train"
    [[ $(wc -l <"$scratch/of$ranks/curves.csv") == 41 ]] || complain "$ranks ranks: another number of rows"
    (($(apart alone "of$ranks") <= 100)) || complain "$ranks ranks: losses $(apart alone "of$ranks") millionths off"
done
sanitized || same_run alone of1

config 1e-3 160
train 2 whole || complain "two ranks do not train"
train 2 again || complain "two ranks do not train again"
same_run whole again

# A rank that dies ends the run; it goes on from the last checkpoint.
train 2 killed 2>/dev/null &
run=$!
for _ in $(seq 300); do
    [[ -e $scratch/killed/curves.csv && $(wc -l <"$scratch/killed/curves.csv") -gt 10 ]] && break
    sleep 0.05
done
pkill -9 -f -n -- "-o $scratch/killed --quiet --mpi" || complain "there was no rank to kill"
wait $run && complain "a run that lost a rank ended well"
refuses 1 "made by 2 ranks, these are 1" train 0 killed --resume
train 2 killed --resume || complain "a run that lost a rank does not go on"
same_run whole killed

# One line of one rank, and nobody waits.
rm "$scratch/samples/000001.exr"
train 2 again --resume 2>"$scratch/stderr" && complain "another number of samples is taken"
[[ $(grep -c "^merlin-lab train: .*number of samples" "$scratch/stderr") == 1 ]] || complain "not one line: $(cat "$scratch/stderr")"
train 3 odd 2>"$scratch/stderr" && complain "three ranks share a batch of four"
grep -q "a batch of 4 is not to be shared by 3 ranks" "$scratch/stderr" || complain "not said: $(cat "$scratch/stderr")"
[[ ! -e $scratch/odd ]] || complain "a run that could not start left a folder"
finish
