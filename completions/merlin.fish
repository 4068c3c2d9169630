# Fish completion for merlin and merlin-lab: install it as share/fish/vendor_completions.d/merlin.fish and merlin-lab.fish.
# Commands and options are what --help says.

function __merlin_words # those before the one that is completed, without options
    string match --invert -- '-*' (commandline --tokenize-at-cursor 2>/dev/null; or commandline -opc)[2..]
end

function __merlin_program
    commandline -opc | head -n 1
end

function __merlin_commands
    (__merlin_program) --help 2>/dev/null | string replace --filter --regex '^  ([a-z]+) +(.*)' '$1\t$2'
end

function __merlin_verbs
    set -l name (string replace --regex '.*/' '' -- (__merlin_program))
    (__merlin_program) $argv[1] --help 2>/dev/null | string replace --filter --regex "^ +$name $argv[1] ([a-z][a-z0-9]*) .*" '$1'
end

# Each of a help's options, and what it says behind them.
function __merlin_options
    set -l words (__merlin_words)
    set -l command $words[1]
    contains -- "$words[2]" (__merlin_verbs $words[1]); and set -a command $words[2]
    for line in ((__merlin_program) $command --help 2>/dev/null | string match --regex '^ +(?:-[a-z], )?--[a-z].*' | string trim)
        set -l parts (string split --max 1 --no-empty '  ' -- $line)
        for option in (string match --all --regex -- '--?[a-z][a-z-]*' $parts[1])
            printf '%s\t%s\n' $option (string trim -- "$parts[2]")
        end
    end
end

function __merlin_previous
    set -l tokens (commandline -opc)
    contains -- $tokens[-1] $argv
end

# The words, each behind what a list has up to its last comma.
function __merlin_list
    set -l before (string match --regex '^.*,' -- (commandline -ct))
    printf '%s\n' "$before"$argv
end

for program in merlin merlin-lab
    complete -c $program -n 'test (count (__merlin_words)) = 0' -f -a '(__merlin_commands)'
    complete -c $program -n 'test (count (__merlin_words)) = 0' -f -a help -d 'explain a command'
    complete -c $program -n 'test (count (__merlin_words)) = 0' -f -a '--help --version -V'
    complete -c $program -n 'test (count (__merlin_words)) = 1; and test (__merlin_words)[1] = help' -f -a '(__merlin_commands)'
    complete -c $program -n 'test (count (__merlin_words)) = 1; and test (__merlin_words)[1] != help' -a '(__merlin_verbs (__merlin_words)[1])'
    complete -c $program -n 'test (count (__merlin_words)) = 1; and test (__merlin_words)[1] = info' -a 'merlin-any merlin-point merlin-env'
    complete -c $program -n 'test (count (__merlin_words)) -ge 1; and string match --quiet -- "-*" (commandline -ct)' -f -a '(__merlin_options)'
    complete -c $program -n '__merlin_previous --by' -f -a 'brdf network'
    complete -c $program -n '__merlin_previous --rti' -f -a 'ptm lrgb hsh rbf'
    complete -c $program -n '__merlin_previous --normal-y' -f -a 'up down'
    complete -c $program -n '__merlin_previous --maps' -f -a '(__merlin_list albedo normal roughness smoothness ao orm height height32 alpha materialx all)'
    complete -c $program -n '__merlin_previous --format' -f -a 'png jpg'
    complete -c $program -n '__merlin_previous --method' -f -a 'ls robust near semi universal uncalibrated auto'
    complete -c $program -n '__merlin_previous --integrate' -f -a 'ls edges'
    complete -c $program -n '__merlin_previous --sphere' -f -a 'chrome matte'
    complete -c $program -n '__merlin_previous --precision' -f -a 'float32 bfloat16'
    complete -c $program -n '__merlin_previous --model --init --init-shared' -a 'merlin-any merlin-point merlin-env'
end
