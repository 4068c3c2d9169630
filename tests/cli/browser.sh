#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The page that estimates in the browser, made by tools/make-web and served by a plain web server: its maps are held to
# merlin estimate's. Where Chromium, npm, a compiler for WebAssembly or the network is missing the test says so and is skipped.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/browser.bash
source "$(dirname "$0")/support/browser.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
source_folder=${MERLIN_SOURCE_DIR:?} examples=$MERLIN_SOURCE_DIR/examples hands=$(cat "$(dirname "$0")/support/browser_hands.js")
cd "$scratch" || exit 1

if sanitized; then
    echo "skipped: a browser runs the page without sanitizers"
    exit 77
fi
[[ -n ${MERLIN_LAB-} ]] || { echo "skipped: there is no merlin-lab, which writes the page's networks"; exit 77; }
command -v python3 >/dev/null || { echo "skipped: there is no python3 to serve the page"; exit 77; }
made=0
"$source_folder/tools/make-web" "$(dirname "$MERLIN")" site 2>made.txt || made=$?
((made != 3)) || { echo "skipped: $(cat made.txt)"; exit 77; }
((made == 0)) || { complain "no page could be made: $(cat made.txt)"; finish; }
browser_start || { echo "skipped: there is no Chromium, so nobody opens the page"; exit 77; }
python3 -u -m http.server 0 --bind 127.0.0.1 -d site >port.txt 2>server.txt &
server=$!
trap 'kill "$server" 2>/dev/null; rm -rf "$scratch"' EXIT
for _ in {1..100}; do grep -q port port.txt && break || sleep 0.1; done
page=http://127.0.0.1:$(grep -o 'port [0-9]*' port.txt | cut -d' ' -f2)/index.html

# in_page EXPRESSION: with the functions of browser_hands.js.
in_page() { browser_eval "(async () => { $hands
return $1; })()"; }

# dropped PHOTO PATTERN: the page takes it, and says so of its object.
dropped() {
    local said
    browser_drop '#files' "$1"
    said=$(in_page 'await taken() + get("object").textContent')
    [[ $said =~ $2 ]] || complain "the page says of $1: $said"
}

# estimated PHOTO FOLDER OPTIONS-OF-MERLIN...: the maps of the photograph that was taken by the page in FOLDER, and by the
# command in FOLDER.merlin.
estimated() {
    local photo=$1 folder=$2 name
    shift 2
    echo "  $(in_page 'await estimated()')"
    mkdir "$folder"
    for name in albedo.png normal.png roughness.png depth.png reconstruction.png mask.png maps.exr report.json viewer.html; do
        in_page "await file('$name')" | base64 -d >"$folder/$name"
    done
    "$MERLIN" estimate "$photo" -o "$folder.merlin" "$@" >/dev/null 2>stderr || complain "estimate $photo: $(cat stderr)"
}

# close FOLDER DEGREES ALBEDO OTHERS [MAP]: the maps, and MAP, differ from the command's by at most so many degrees and per cent
# in the mean.
close() {
    local angle name differ most
    angle=$("$NORMALS_DIFFER" "$1" "$1.merlin")
    awk -v a="${angle:-90}" -v most="$2" 'BEGIN { exit !(a <= most) }' || complain "$1: normals differ by $angle degrees"
    echo "  normals $angle degrees"
    for name in albedo roughness depth mask ${5-}; do
        differ=$("${PICTURES_DIFFER:?}" "$1.merlin/$name.png" "$1/$name.png")
        most=$4
        [[ $name != albedo ]] || most=$3
        awk -v most="$most" '{ exit !($1 <= most) }' <<<"${differ:-100}" || complain "$1: $name differs by $differ per cent"
        echo "  $name $differ per cent"
    done
}

echo "without WebAssembly the page says so"
browser_open "$page" 1200 900
browser_call Page.addScriptToEvaluateOnNewDocument '{"source":"delete window.WebAssembly;"}' && browser_call Page.reload '{}'
for _ in {1..100}; do
    said=$(in_page 'trouble()') # while it is loaded anew there is no page to ask
    [[ $said != This* ]] || break
    sleep 0.1
done
[[ $said == "This browser has no WebAssembly"* ]] || complain "without WebAssembly the page says: $said"

browser_open "$page" 1200 900
# The command computes networks in bfloat16 where the processor does, the page in float32. Measured: normals 0.13 degrees, albedo
# 0.05 per cent, roughness 0.19, depth 0.13, the reconstruction 0.06.
echo "a photograph by flash has the command's maps"
dropped "$examples/demo.png" '^The object was found.$'
estimated "$examples/demo.png" flash
close flash 0.5 0.2 0.5 reconstruction
grep -q '"model":.*"merlin-point"' flash/report.json || complain "the flash was not seen: $(grep '"model"' flash/report.json)"

echo "the files it gives are a folder for merlin's commands"
for folder in flash flash.merlin; do
    "$MERLIN" relight "$folder" --light 0.7,0.3,-0.4 -o "$folder.relit" >/dev/null 2>stderr || complain "relight $folder: $(cat stderr)"
done
differ=$("$PICTURES_DIFFER" flash.relit/relit.png flash.merlin.relit/relit.png)
awk '{ exit !($1 <= 0.5) }' <<<"${differ:-100}" || complain "relit they differ by $differ per cent"
succeeds flash "$MERLIN" view flash -o again.html

echo "a photograph in a window's light has the command's maps"
in_page 'choose("quick", true)' >/dev/null
dropped "$examples/window.png" '^The object was found.$'
estimated "$examples/window.png" window --size 256
close window 0.5 0.2 0.5 reconstruction

echo "a turned JPEG, whose EXIF tells lens and flash, with a painted mask has the command's maps"
in_page "await jpeg_of('reconstruction.png', 600, 480)" | base64 -d >plain.jpg
{
    head -c 2 plain.jpg
    printf '\xff\xe1\0\x4cExif\0\0MM\0*\0\0\0\x08'
    printf '\0\x02\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\x87\x69\0\x04\0\0\0\x01\0\0\0\x26\0\0\0\0'
    printf '\0\x02\x92\x09\0\x03\0\0\0\x01\0\x10\0\0\xa4\x05\0\x03\0\0\0\x01\0\x32\0\0\0\0\0\0'
    tail -c +3 plain.jpg
} >turned.jpg
dropped turned.jpg .
said=$(in_page 'get("picture").width + " " + get("picture").height + " " + get("fov").placeholder')
[[ $said == "480 600 "* ]] || complain "a turned photograph is so wide and high, and so much is its field of view: $said"
said=$(in_page 'await painted("add", [0.05, 0.95], [0.12, 0.95])')
[[ $said == "The mask is yours." ]] || complain "the page says of a painted mask: $said"
estimated turned.jpg turned --size 256 --mask turned/mask.png
grep -q '"model":.*"merlin-any"' turned/report.json || complain "no flash fired, and yet: $(grep '"model"' turned/report.json)"
close turned 0.5 0.2 0.5 # no light is found in this made photograph: its reconstruction is black

echo "trouble is told"
printf 'no picture' >words.png
dropped words.png 'cannot open this picture'
in_page 'await blank(2400, 1200)' | base64 -d >blank.png
dropped blank.png '^No object stands out from the background. Paint the object by .* was reduced to 2048 × 1024 pixels.$'
[[ $(in_page 'get("estimate").disabled') == true ]] || complain "an estimate without an object is offered"
dropped "$examples/window.png" .
said=$(in_page 'await cancelled()')
[[ $said == Cancelled ]] || complain "after a cancelled estimate the page says $said"
said=$(in_page 'nameless()')
[[ -z $said ]] || complain "these have no name for screen readers: $said"

echo "neither the page nor a worker like its own reaches another host"
said=$(in_page 'await other_host(fetch) + await other_host(in_worker)')
[[ $said == refusedrefused ]] || complain "another host is $said"

echo "once its networks are there the page needs no server"
kill "$server"
wait "$server" 2>/dev/null
dropped "$examples/demo.png" '^The object was found.$'
said=$(in_page 'await estimated()')
[[ $said == "Done by merlin-point, "* ]] || complain "without its server the page says $said"

echo "narrow windows have all of it"
browser_call Emulation.setDeviceMetricsOverride '{"width":320,"height":640,"deviceScaleFactor":1,"mobile":true}'
wide=$(browser_eval '`${document.documentElement.scrollWidth}`')
[[ $wide -le 320 ]] || complain "the page is $wide pixels wide in a window of 320"

browser_end
finish
