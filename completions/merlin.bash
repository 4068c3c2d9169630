# SPDX-License-Identifier: MIT
# Bash completion for merlin and merlin-lab: source it, or install it as share/bash-completion/completions/merlin and
# merlin-lab. Commands and options are what --help says.

_merlin() {
    local merlin=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local words=("${COMP_WORDS[1]}") name=${merlin##*/} commands verbs more=()
    commands=$("$merlin" --help 2>/dev/null | sed -n 's/^  \([a-z]*\)  *.*/\1/p')
    if [[ $current == = ]]; then # --by=, in words of its own
        current=
    elif [[ $previous == = ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    if ((COMP_CWORD == 1)); then
        mapfile -t COMPREPLY < <(compgen -W "$commands help --help --version -V" -- "$current")
        return
    fi
    if [[ ${words[0]} == help ]]; then
        ((COMP_CWORD == 2)) && mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current") && return
        words=("${COMP_WORDS[2]}")
    fi
    verbs=$("$merlin" "${words[0]}" --help 2>/dev/null | sed -n "s/^  *$name ${words[0]} \([a-z][a-z0-9]*\) .*/\1/p")
    if [[ ${COMP_WORDS[1]} == help ]]; then
        ((COMP_CWORD > 3)) || mapfile -t COMPREPLY < <(compgen -W "$verbs" -- "$current")
        return
    fi
    if ((COMP_CWORD == 2)); then # words that may stand where a file may
        [[ ${words[0]} == info ]] && verbs="merlin-any merlin-point merlin-env"
        mapfile -t more < <(compgen -W "$verbs" -- "$current")
    elif [[ " "$verbs" " =~ [[:space:]]"${COMP_WORDS[2]}"[[:space:]] ]]; then
        words+=("${COMP_WORDS[2]}")
    fi
    case $previous in
    --by) mapfile -t COMPREPLY < <(compgen -W "brdf network" -- "$current") ;;
    --rti) mapfile -t COMPREPLY < <(compgen -W "ptm lrgb hsh rbf" -- "$current") ;;
    --normal-y) mapfile -t COMPREPLY < <(compgen -W "up down" -- "$current") ;;
    --maps)
        local before=
        [[ $current != *,* ]] || before=${current%,*},
        mapfile -t COMPREPLY < <(compgen -P "$before" -W "albedo normal roughness smoothness ao orm height height32 alpha materialx all" -- "${current##*,}")
        ;;
    --format) mapfile -t COMPREPLY < <(compgen -W "png jpg" -- "$current") ;;
    --method) mapfile -t COMPREPLY < <(compgen -W "ls robust near semi universal uncalibrated auto" -- "$current") ;;
    --integrate) mapfile -t COMPREPLY < <(compgen -W "ls edges" -- "$current") ;;
    --sphere) mapfile -t COMPREPLY < <(compgen -W "chrome matte" -- "$current") ;;
    --precision) mapfile -t COMPREPLY < <(compgen -W "float32 bfloat16" -- "$current") ;;
    --model | --init | --init-shared) mapfile -t COMPREPLY < <(compgen -W "merlin-any merlin-point merlin-env" -f -- "$current") ;;
    --data | --means | --env-dir | --material-dir) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    *)
        if [[ $current == -* ]]; then
            mapfile -t COMPREPLY < <(compgen -W "$("$merlin" "${words[@]}" --help 2>/dev/null |
                grep -oE '^ +(-[a-z], )?--[a-z-]+(, --[a-z-]+| [A-Z,]+, --[a-z-]+)*' | grep -oE -e '--[a-z-]+')" -- "$current")
        else
            mapfile -t COMPREPLY < <(compgen -f -- "$current")
            COMPREPLY+=("${more[@]}")
        fi
        ;;
    esac
}
complete -o filenames -F _merlin merlin merlin-lab
