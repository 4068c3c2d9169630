#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What broken and hostile clients do to merlin serve, and what a full disk and a kill do: it goes on, says one thing, and
# keeps nothing.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
# shellcheck source=tests/cli/support/server.bash
source "$(dirname "$0")/support/server.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
demo=${MERLIN_SOURCE_DIR:?}/examples/demo.png
cd "$scratch" || exit 1

# The folders of uploads and jobs that there are.
kept() { find tmp/merlin-serve-* -mindepth 1 -maxdepth 1 -type d | wc -l; }

# empties: what was cut off is gone soon.
empties() {
    for _ in {1..450}; do
        (($(kept) == 0)) && return
        sleep 0.1
    done
    complain "$1: $(find tmp) stays"
}

# posts LENGTH BODY: a POST of these bytes (printf's words) that says it has so many.
posts() { raw "POST /v1/estimate HTTP/1.1\r\nHost: 127.0.0.1:$port\r\nConnection: close\r\nContent-Type: multipart/form-data; boundary=XYZ\r\nContent-Length: $1\r\n\r\n$2"; }

# refuses_body PATTERN BODY: 400, and a line that says it.
refuses_body() {
    posts "$(printf -- "$2" | wc -c)" "$2" >answer
    grep -q '^HTTP/1.1 400' answer && grep -q -e "$1" answer || complain "${2:0:200} was answered $(head -1 answer; tail -1 answer)"
}

server_start --upload 1 --waiting 2 || exit 77

echo "bodies that are too large are refused before, or as, they come"
posts 99999999999999 '' | grep -q '^HTTP/1.1 413' || complain "a giant body is not refused"
posts 99999999999999999999999999 '' | grep -q '^HTTP/1.1 4' || complain "a length beyond all numbers is not refused"
posts -5 '' | grep -q '^HTTP/1.1 4' || complain "a length below zero is not refused"
head -c 1600000 /dev/zero >large
asks 413 'more than 1 million bytes\|larger than this server takes' "$site/v1/estimate" -F photo=@large
asks 413 'more than 1 million bytes' "$site/v1/estimate" -H 'Transfer-Encoding: chunked' -F photo=@large
head -c 30000000 /dev/zero >giant
curl -s -o body -H 'Transfer-Encoding: chunked' -F photo=@giant "$site/v1/estimate" && complain "30 MB were read: $(cat body)"
raw "DELETE /v1/jobs/x HTTP/1.1\r\nHost: 127.0.0.1:$port\r\nContent-Length: 9999999\r\n\r\n" | grep -q '^HTTP/1.1 413' || complain "a body of DELETE is read"
empties "large bodies"

echo "forms that are broken are refused with a word"
part='--XYZ\r\nContent-Disposition: form-data; name="photo"; filename="a.png"\r\n\r\n'
refuses_body 'proper multipart' "${part}abc"
refuses_body 'proper multipart' "${part}abc\r\n--XYZ\r\n"
refuses_body 'multipart\|no file' '--ABC\r\nContent-Disposition: form-data; name="photo"\r\n\r\nabc\r\n--ABC--\r\n'
refuses_body 'multipart\|without a name' '--XYZ\r\nContent-Disposition: form-data\r\n\r\nabc\r\n--XYZ--\r\n'
refuses_body 'without a name' '--XYZ\r\nContent-Disposition: form-data; name="../photo"; filename="a"\r\n\r\nabc\r\n--XYZ--\r\n'
refuses_body 'no file' '--XYZ--\r\n'
refuses_body . 'no form at all'
refuses_body . '\001\002\377\000\r\n\r\n--XYZ'
long=$(head -c 5000 /dev/zero | tr '\0' a)
refuses_body 'too long' "--XYZ\r\nContent-Disposition: form-data; name=\"size\"\r\n\r\n$long\r\n--XYZ--\r\n"
refuses_body . "--XYZ\r\nContent-Disposition: form-data; name=\"$long\"; filename=\"a\"\r\n\r\nabc\r\n--XYZ--\r\n"
for type in 'multipart/form-data' 'multipart/form-data; boundary=' 'multipart/mixed; boundary=XYZ' application/json; do
    asks 400 'multipart' "$site/v1/estimate" -H "Content-Type: $type" -d abc
done
asks 400 . "$site/v1/estimate" -H "Content-Type: multipart/form-data; boundary=$long" -d abc
empties "broken forms"

echo "thousands of parts are refused"
many=()
for ((i = 0; i < 2000; i++)); do many+=(-F point=1,2); done
asks 400 'more than 128 fields' "$site/v1/estimate" "${many[@]}"
echo x >x
many=()
for ((i = 0; i < 2000; i++)); do many+=(-F pictures=@x); done
asks 400 'more than 1024 files' "$site/v1/stereo" "${many[@]}"
empties "thousands of parts"

echo "clients that lie about a length, or leave, leave nothing"
posts 500000 "${part}abc" >answer &
lying=$!
for ((i = 0; i < 5; i++)); do
    curl -s --limit-rate 20k -o /dev/null -F photo=@large -H 'Transfer-Encoding: chunked' "$site/v1/estimate" &
    leaving=$!
    sleep 0.2
    kill $leaving
    wait $leaving 2>/dev/null
done
posts 10 "${part}abcdefghijklmnopqrstuvwxyz\r\n--XYZ--\r\n" >answer; grep -q "^HTTP/1.1 400" answer || complain "more than was announced is not refused"

echo "slow clients keep nobody waiting"
sockets=()
for ((i = 0; i < 60; i++)); do
    exec {slow}<>"/dev/tcp/127.0.0.1/$port"
    printf 'POST /v1/estimate HTTP/1.1\r\nHost: 127' >&"$slow"
    sockets+=("$slow")
done
asks 200 version --max-time 5 "$site/v1/status"
for slow in "${sockets[@]}"; do exec {slow}>&-; done
kill $lying 2>/dev/null
wait $lying 2>/dev/null
empties "clients that left"

echo "the queue is no longer than it says"
taken=0 busy=0
for ((i = 0; i < 6; i++)); do
    code=$(curl -s -o body -w '%{http_code}' -F photo=@"$demo" "$site/v1/estimate")
    case $code in 202) taken=$((taken + 1)) ;; 503) grep -q '"code":"busy"' body && busy=$((busy + 1)) ;; esac
done
((taken >= 2 && busy >= 1 && taken + busy == 6)) || complain "$taken of 6 were taken and $busy refused"

echo "what a killed server leaves goes at the next start"
disown $server
kill -KILL "$server"
sleep 0.2
(($(kept) > 0)) || complain "it left nothing to remove"
mkdir -p tmp/merlin-serve-mine tmp/other
touch tmp/merlin-serve-file
server_start --keep 1
[[ $(ls -d tmp/merlin-serve-*/lock | wc -l) == 1 ]] || complain "leftovers stay: $(find tmp)"
[[ -d tmp/other && -f tmp/merlin-serve-file && -d tmp/merlin-serve-mine ]] || complain "what is not a server's was removed: $(ls tmp)"
rm -r tmp/other tmp/merlin-serve-file tmp/merlin-serve-mine
server_end INT

echo "other machines need the token, and the whole token"
echo 0123456789abcdef >token
server_start --host 127.0.0.1 --token token --name studio.lan
asks 401 no_token "$site/v1/status"
grep -qi 'www-authenticate: bearer' head || complain "401 does not say what is asked for"
asks 401 no_token "$site/"
asks 401 no_token -F photo=@"$demo" "$site/v1/estimate"
asks 401 no_token -H 'Authorization: Bearer 0123456789abcdeg' "$site/v1/status"
asks 401 no_token "$site/v1/status?token=0123456789abcdef"
asks 401 no_token -H "Cookie: merlin-$port=0123456789abcde" "$site/v1/status"
asks 200 version -H 'Authorization: Bearer 0123456789abcdef' "$site/v1/status"
asks 200 version -H 'Authorization: Bearer 0123456789abcdef' -H 'Host: studio.lan' "$site/v1/status"
asks 403 wrong_host -H 'Authorization: Bearer 0123456789abcdef' -H "Host: evil.example:$port" "$site/v1/status"
asks 303 '' "$site/?token=0123456789abcdef"
grep -qi "^set-cookie: merlin-$port=0123456789abcdef; Path=/; HttpOnly; SameSite=Strict" head || complain "no cookie: $(cat head)"
asks 200 '<title>merlin' -H "Cookie: merlin-$port=0123456789abcdef" "$site/"
server_end

echo "a full disk fails one job, and the server goes on"
mkdir -p disk
space=(unshare -m)
((EUID == 0)) || space=(unshare -rm)
if "${space[@]}" mount -t tmpfs -o size=1400k none disk 2>/dev/null; then
    cat >on_small_disk <<'SCRIPT'
mount -t tmpfs -o size=1400k none "$TMPDIR" && exec "$REAL" "$@"
SCRIPT
    export REAL=$MERLIN
    printf '#!/bin/sh\nexec %s sh %s/on_small_disk "$@"\n' "${space[*]}" "$scratch" >small
    chmod +x small
    MERLIN=$scratch/small server_tmp=$scratch/disk server_start
    full=$(submit estimate -F photo=@"$demo")
    told "$full" | grep -q '"state":"failed".*"error":".*No space left' || complain "on a full disk: $(told "$full" | head -c 500)"
    asks 507 'No space left' "$site/v1/estimate" -F photo=@large
    small=$(submit mask -F photo=@"$demo" -F side=64)
    told "$small" | grep -q '"state":"done"' || complain "the server does not go on: $(told "$small")"
    server_end
else
    echo "no small disk can be mounted here: a full one is not tried"
fi
finish
