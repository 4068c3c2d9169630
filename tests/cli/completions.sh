#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every option that a command takes is in its help and in the manual, and bash, zsh and fish complete exactly those.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
completions=$MERLIN_SOURCE_DIR/completions
mkdir "$scratch/bin"
ln -s "$(realpath "$MERLIN")" "$scratch/bin/merlin"
[[ -z ${MERLIN_LAB:-} ]] || ln -s "$(realpath "$MERLIN_LAB")" "$scratch/bin/merlin-lab"
PATH=$scratch/bin:$PATH
cd "$scratch" || exit 1
# PROGRAM COMMAND
commands=("merlin estimate" "merlin relight" "merlin view" "merlin export" "merlin stereo" "merlin stereo calibrate" "merlin serve" "merlin info")
[[ -z ${MERLIN_LAB:-} ]] || for command in render train eval "eval stereo" "eval solvers" "eval detail" "eval doubts" \
    "eval masks" "eval lights" "eval several" "eval pictures" "eval photos" average export bench; do commands+=("merlin-lab $command"); done

manual() { sed 's/\\-/-/g; s/\\f.//g' "$MERLIN_SOURCE_DIR/man/$1.1"; } # PROGRAM
in_source() { # PROGRAM COMMAND: the names in its table, and those of the table that all have
    local folder=cli
    [[ $1 == merlin ]] || folder=lab/cli
    grep -ohE '\{"[a-z-]+"(, .[a-z].)?, \.[a-z]+ = ' "$(find "$MERLIN_SOURCE_DIR/src/$folder" -name "cmd_${2// /_}.c")" \
        "$MERLIN_SOURCE_DIR/src/command/options.c" | sed 's/{"\([a-z-]*\)".*/--\1/' | sort -u
}
in_help() { # WORD...
    "$@" --help | grep -oE '^ +(-[a-z], )?--[a-z-]+(( [A-Z,]+)?, --[a-z-]+)*' | grep -oE -e '--[a-z-]+' | sort -u
}
# shellcheck source=completions/merlin.bash
source "$completions/merlin.bash"
by_bash() { # WORD...: the words of a command line, the last one to be completed
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _merlin
    printf '%s\n' "${COMPREPLY[@]}"
}
by_fish() { fish --no-config -c 'source $argv[1]; complete -C "$argv[2]"' "$completions/merlin.fish" "$*" | cut -f 1; }
# What zsh's function of that name would offer: descriptions are cut off by compadd's callers, hence by _describe's double.
by_zsh() {
    zsh -f -c '_describe() { print -rl -- ${${(P)2}%%:*} }; _values() { shift; print -rl -- "$@" }; _files() { : }
        completion=$1; shift; words=("$@") CURRENT=${#words} PREFIX=${words[-1]}; source $completion' zsh \
        "$completions/_merlin" "$@"
}
same() { # WHAT EXPECTED GOT
    [[ $2 == "$3" ]] || complain "$1: $(diff <(echo "$2") <(echo "$3") | grep '^[<>]' | tr '\n' ' ')"
}
completes() { # SHELL WORD LINE...: the word is among what the shell offers for the line
    local shell=$1 word=$2
    shift 2
    "by_$shell" "$@" | grep -qxF -e "$word" || complain "$shell does not complete $* to $word but to: $("by_$shell" "$@" | tr '\n' ' ')"
}

shells=(bash)
for shell in zsh fish; do
    if command -v $shell >/dev/null; then shells+=($shell); else echo "no $shell here: its completion is not tested"; fi
done
for command in "${commands[@]}"; do
    read -ra words <<<"$command"
    expected=$(in_source "${words[0]}" "${command#* }")
    [[ $(wc -l <<<"$expected") -ge 4 ]] || complain "no table of options was found for $command"
    same "$command --help beside its table" "$expected" "$(in_help "${words[@]}")"
    for option in $expected; do
        [[ $(manual "${words[0]}") == *"$option"* ]] || complain "the manual does not know $option of $command"
    done
    for shell in "${shells[@]}"; do
        same "$shell for $command" "$expected" "$("by_$shell" "${words[@]}" -- | grep -e -- | sort -u)"
    done
done
for shell in "${shells[@]}"; do
    completes "$shell" relight merlin rel
    [[ -z ${MERLIN_LAB:-} ]] || completes "$shell" photos merlin-lab eval ph
    [[ -z ${MERLIN_LAB:-} ]] || completes "$shell" table2 merlin-lab eval ta
    completes "$shell" calibrate merlin stereo c
    completes "$shell" merlin-env merlin relight photo.png --model merlin-e
    completes "$shell" network merlin relight photo.png --by n
    completes "$shell" stereo merlin help st
    completes "$shell" hsh merlin relight photo.png --rti h
    completes "$shell" down merlin export photo.merlin --normal-y d
    completes "$shell" height32 merlin export photo.merlin --maps hei
    # zsh's own function for lists is asked about their first word alone
    [[ $shell == zsh ]] || completes "$shell" albedo,normal merlin export photo.merlin --maps albedo,nor
done
completes bash network merlin relight photo.png --by = # as the shell parts --by=
completes bash network merlin relight photo.png --by = n
completes bash merlin-env merlin relight photo.png --model = merlin-e
[[ -z ${MERLIN_LAB:-} ]] || completes bash photos merlin-lab help eval ph
finish
