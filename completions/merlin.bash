# Bash completion for merlin: source it, or install it as share/bash-completion/completions/merlin.

_merlin() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} more=()
    local -A options=(
        [estimate]="--mask --output --model --size --views --exposure --mesh --json --threads --quiet --help"
        [relight]="--light --direction --lights --orbit --dome --lp --near --radius --power --color --exposure --format --env --rotate --env-exposure --by --no-shadows --matte --frame --mask --output --model --size --views --photo-exposure --json --threads --quiet --help"
        [stereo]="--lights --near --fov --distance --method --mask --ambient --linear --integrate --mesh --output --model --size --views --exposure
            --json --threads --quiet --help"
        ["stereo calibrate"]="--sphere --mask --linear --fov --output --json --threads --quiet --help"
        [render]="--count --output --seed --first --size --fov --mesh --env-dir --material-dir --no-env --targets --bounces --spp --paths
            --json --threads --quiet --help"
        [train]="--data --output --resume --init --init-shared --note --threads --quiet --help"
        [eval]="--data --model --means-file --count --white --given --environments --views --precision --figure --figure-rows --means --output
            --json --threads --quiet --help"
        ["eval stereo"]="--data --model --count --figure --json --threads --quiet --help"
        ["eval detail"]="--data --model --count --views --json --threads --quiet --help"
        ["eval doubts"]="--right --wrong --data --count --model --json --threads --quiet --help"
        ["eval masks"]="--data --mask --count --seed --json --threads --quiet --help"
        ["eval solvers"]="--count --seed --size --json --threads --quiet --help"
        ["eval photos"]="--model --output --mask --threads --quiet --help"
        [bench]="--model --config --batch --stereo --profile --quick --json --threads --quiet --help"
        [info]="--tensors --json --threads --quiet --help"
    )
    local -A below=([eval]="stereo solvers detail photos doubts masks" [stereo]="calibrate")
    local commands="estimate relight stereo render train eval bench info"
    if [[ $current == = ]]; then # --by=, in words of its own
        current=
    elif [[ $previous == = ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    if ((COMP_CWORD == 1)); then
        mapfile -t COMPREPLY < <(compgen -W "$commands help --help --version" -- "$current")
        return
    fi
    if ((COMP_CWORD == 2)); then
        case $command in # words that may stand where a file may
        help) mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current") && return ;;
        eval | stereo) mapfile -t more < <(compgen -W "${below[$command]}" -- "$current") ;;
        info) mapfile -t more < <(compgen -W "merlin-point merlin-env" -- "$current") ;;
        esac
    elif [[ $command == help ]]; then
        ((COMP_CWORD > 3)) || mapfile -t COMPREPLY < <(compgen -W "${below[$previous]-}" -- "$current")
        return
    elif [[ -n ${options["$command ${COMP_WORDS[2]}"]-} ]]; then
        command+=" ${COMP_WORDS[2]}"
    fi
    case $previous in
    --by) mapfile -t COMPREPLY < <(compgen -W "brdf network" -- "$current") ;;
    --method) mapfile -t COMPREPLY < <(compgen -W "ls robust near semi uncalibrated auto" -- "$current") ;;
    --integrate) mapfile -t COMPREPLY < <(compgen -W "ls edges" -- "$current") ;;
    --sphere) mapfile -t COMPREPLY < <(compgen -W "chrome matte" -- "$current") ;;
    --precision) mapfile -t COMPREPLY < <(compgen -W "float32 bfloat16" -- "$current") ;;
    --model | --init | --init-shared) mapfile -t COMPREPLY < <(compgen -W "merlin-point merlin-env" -f -- "$current") ;;
    --data | --means | --env-dir | --material-dir) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    *)
        if [[ $current == -* ]]; then
            mapfile -t COMPREPLY < <(compgen -W "${options[$command]-}" -- "$current")
        else
            mapfile -t COMPREPLY < <(compgen -f -- "$current")
            COMPREPLY+=("${more[@]}")
        fi
        ;;
    esac
}
complete -o filenames -F _merlin merlin
