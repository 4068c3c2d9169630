# SPDX-License-Identifier: MIT
# A headless Chromium that a script drives by the DevTools protocol, through pipes: no port, no other program.
#
#     browser_start || exit 77                            where there is none
#     browser_open "file://$PWD/viewer.html" 800 600      and waits until the page has drawn
#     browser_eval 'document.title'                       prints what it is, a text or a number
#     browser_drop '#file' room.hdr                       into a file input
#     browser_picture shot.png 512                        the upper left part of the window, so many pixels a side
#     browser_end
#
# shellcheck shell=bash disable=SC2154 # scratch: check.bash

# browser_start: false where no browser is to be had.
browser_start() {
    local program=
    for program in chromium chromium-browser google-chrome; do command -v "$program" >/dev/null && break; done
    command -v "$program" >/dev/null || return 1
    mkfifo "$scratch/to_browser" "$scratch/from_browser" || return 1
    exec {to_browser}<>"$scratch/to_browser" {from_browser}<>"$scratch/from_browser"
    # the pages are our own, and containers have no room for a sandbox
    "$program" --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --force-color-profile=srgb \
        --force-prefers-reduced-motion --hide-scrollbars --no-first-run --disable-dev-shm-usage --user-data-dir="$scratch/browser" \
        --remote-debugging-pipe 3<"$scratch/to_browser" 4>"$scratch/from_browser" 2>"$scratch/browser.txt" &
    browser=$!
    browser_calls=0
    browser_session=
    browser_call Target.getTargets '{}'
}

# browser_call METHOD PARAMETERS: leaves the answer in $answer.
browser_call() {
    local id=$((++browser_calls)) session=${browser_session:+,\"sessionId\":\"$browser_session\"}
    printf '{"id":%d,"method":"%s","params":%s%s}\0' "$id" "$1" "$2" "$session" >&"$to_browser"
    while IFS= read -r -d '' -t 180 answer <&"$from_browser"; do
        [[ $answer == "{\"id\":$id,"* ]] && return
    done
    complain "the browser does not answer $1: $(tail -3 "$scratch/browser.txt")"
    return 1
}

# Text as JSON has it, with its quotes.
json_text() {
    printf '"%s"' "$(sed 's/\\/\\\\/g; s/"/\\"/g; $!s/$/\\n/' <<<"$1" | tr -d '\n')"
}

browser_open() {
    local ready='(async () => {
        const root = document.documentElement, trouble = () => !document.getElementById("trouble").hidden;
        while (root.dataset.ready === undefined && !trouble()) await new Promise((done) => setTimeout(done, 50));
        for (let i = 0; i < 3; i++) await new Promise((done) => requestAnimationFrame(done));
        return document.getElementById("trouble").textContent;
    })()'
    browser_session=
    browser_call Target.createTarget '{"url":"about:blank"}' || return 1
    [[ $answer =~ \"targetId\":\"([^\"]+)\" ]] || return 1
    browser_call Target.attachToTarget "{\"targetId\":\"${BASH_REMATCH[1]}\",\"flatten\":true}" || return 1
    [[ $answer =~ \"sessionId\":\"([^\"]+)\" ]] || return 1
    browser_session=${BASH_REMATCH[1]}
    browser_call Emulation.setDeviceMetricsOverride "{\"width\":$2,\"height\":$3,\"deviceScaleFactor\":1,\"mobile\":false}" &&
        browser_call Page.enable '{}' && browser_call Page.navigate "{\"url\":$(json_text "$1")}" || return 1
    local said tries=0
    until [[ $(browser_eval 'document.readyState + location.href') == complete"$1" ]] || ((++tries == 600)); do sleep 0.1; done
    said=$(browser_eval "$ready")
    [[ -z $said ]] || complain "$1 says: $said"
}

browser_eval() {
    browser_call Runtime.evaluate "{\"expression\":$(json_text "$1"),\"awaitPromise\":true,\"returnByValue\":true}" || return 1
    if [[ $answer =~ \"value\":\"(.*)\"\}\} ]]; then
        printf '%b' "${BASH_REMATCH[1]}"
    elif [[ $answer =~ \"value\":([^}]*)\}\} ]]; then
        printf '%s' "${BASH_REMATCH[1]}"
    else
        printf 'no value: %s' "$answer"
    fi
}

browser_drop() {
    browser_call DOM.getDocument '{}' || return 1
    [[ $answer =~ \"nodeId\":([0-9]+) ]]
    browser_call DOM.querySelector "{\"nodeId\":${BASH_REMATCH[1]},\"selector\":\"$1\"}" || return 1
    [[ $answer =~ \"nodeId\":([0-9]+) ]]
    browser_call DOM.setFileInputFiles "{\"nodeId\":${BASH_REMATCH[1]},\"files\":[$(json_text "$(realpath "$2")")]}"
}

browser_picture() {
    browser_call Page.captureScreenshot "{\"format\":\"png\",\"clip\":{\"x\":0,\"y\":0,\"width\":$2,\"height\":$2,\"scale\":1}}" || return 1
    [[ $answer =~ \"data\":\"([^\"]+)\" ]] || return 1
    base64 -d <<<"${BASH_REMATCH[1]}" >"$1"
}

browser_end() {
    browser_session=
    browser_call Browser.close '{}'
    wait "$browser" 2>/dev/null
}
