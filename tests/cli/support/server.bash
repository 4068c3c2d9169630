# SPDX-License-Identifier: MIT
# A merlin serve that a script asks by curl, beside check.bash.
#
#     server_start --keep 5 || exit 77          $site is its address; skips where there is no curl
#     asks 400 'no file "photo"' "$site/v1/estimate" -F size=512
#     job=$(submit estimate -F photo=@cup.jpg)  waits until it has ended; prints its identifier
#     told "$job"                               what the server tells of it
#     server_end
#
# shellcheck shell=bash disable=SC2154 # scratch: check.bash

# server_start OPTIONS...: on a free port, with $scratch/tmp as the folder for temporary files.
server_start() {
    command -v curl >/dev/null || { echo "skipped: there is no curl"; return 1; }
    mkdir -p "$scratch/tmp"
    : >"$scratch/server.txt"
    TMPDIR=${server_tmp:-$scratch/tmp} "$MERLIN" serve --port 0 --json "$@" >"$scratch/server.txt" 2>"$scratch/server.err" &
    server=$!
    trap 'kill "$server" 2>/dev/null; rm -rf "$scratch"' EXIT
    for _ in {1..600}; do
        grep -q address "$scratch/server.txt" && break
        kill -0 "$server" 2>/dev/null || break
        sleep 0.1
    done
    site=$(sed 's|.*"address":"\(http://[^/]*\)/.*|\1|' "$scratch/server.txt")
    port=${site##*:}
    [[ $port =~ ^[0-9]+$ ]] || { complain "no server: $(cat "$scratch/server.err")"; return 1; }
}

# server_end [SIGNAL]: it ends by itself, with status 0, and leaves nothing.
server_end() {
    kill -"${1:-TERM}" "$server"
    wait "$server" || complain "the server exited with $?: $(cat "$scratch/server.err")"
    [[ -z $(ls -A "${server_tmp:-$scratch/tmp}") ]] || complain "the server left $(ls -A "${server_tmp:-$scratch/tmp}")"
    [[ ! -s $scratch/server.err ]] || complain "the server said $(cat "$scratch/server.err")"
}

# asks CODE PATTERN CURL-ARGUMENTS...: the answer has that status, and a line of its body matches. The body is left in
# $scratch/body, the head in $scratch/head.
asks() {
    local code=$1 pattern=$2 got
    shift 2
    got=$(curl -s --max-time 120 -o "$scratch/body" -D "$scratch/head" -w '%{http_code}' "$@") || got="$got, curl $?"
    [[ $got == "$code" ]] || complain "$* was answered $got, not $code: $(head -c 300 "$scratch/body")"
    [[ -z $pattern ]] || grep -q -e "$pattern" "$scratch/body" || complain "$* was not answered \"$pattern\" but: $(head -c 300 "$scratch/body")"
}

told() { curl -s --max-time 60 "$site/v1/jobs/$1"; }

identifier() { sed -n 's/.*"id":"\([0-9a-f]\{32\}\)".*/\1/p'; }

# ended ID: waits until the job has ended.
ended() {
    for _ in {1..1200}; do
        told "$1" | grep -qE '"state":"(queued|working)"' || return 0
        sleep 0.1
    done
    complain "job $1 does not end"
}

submit() {
    local kind=$1 job
    shift
    job=$(curl -s --max-time 120 "$@" "$site/v1/$kind" | tee "$scratch/body" | identifier)
    [[ -n $job ]] || complain "$kind $* was not taken: $(cat "$scratch/body")"
    ended "$job"
    echo "$job"
}

# fetches ID NAME FILE
fetches() { curl -sf --max-time 60 -o "$3" "$site/v1/jobs/$1/files/$2" || complain "job $1 has no $2"; }

# raw WORDS: what is answered to bytes of any kind, printf's words, at the port.
raw() {
    exec {socket}<>"/dev/tcp/127.0.0.1/$port" || return 1
    # shellcheck disable=SC2059
    printf "$1" >&"$socket"
    timeout 20 cat <&"$socket"
    exec {socket}>&-
}
