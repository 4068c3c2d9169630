#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin serve from outside: what it answers, to whom, and what strangers cannot do to it.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
# shellcheck source=tests/cli/support/server.bash
source "$(dirname "$0")/support/server.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
demo=${MERLIN_SOURCE_DIR:?}/examples/demo.png
cd "$scratch" || exit 1

echo "wrong use is refused before anything is opened"
refuses 2 'nothing is expected beside options' "$MERLIN" serve photo.png
refuses 2 '--name goes with --host' "$MERLIN" serve --name example.org
refuses 2 '--port wants a whole number' "$MERLIN" serve --port 65536
echo short >token
refuses 1 'its first line must be 16 to 128' "$MERLIN" serve --token token

server_start || exit 77

echo "the server's folder is open to its owner alone"
[[ $(stat -c %a tmp/merlin-serve-*) == 700 ]] || complain "its mode is $(stat -c %a tmp/merlin-serve-*)"
refuses 1 "cannot listen at 127.0.0.1, port $port" "$MERLIN" serve --port "$port"

echo "a mask is found and sent back, at a page's size"
mask=$(submit mask -F photo=@"$demo" -F side=256)
told "$mask" | grep -q '"width":512,"height":512,"mask_source":"' || complain "$(told "$mask")"
fetches "$mask" mask.png mask.png
fetches "$mask" photo.png cup.png
demo=$PWD/cup.png # from here on: small pictures take the same ways, and are soon done

echo "maps over HTTP are merlin estimate's"
"$MERLIN" estimate "$demo" -o own -q
job=$(submit estimate -F photo=@"$demo")
told "$job" | grep -q '"state":"done","progress":1,.*"files":\[.*"report":{.*"model":"merlin-point"' || complain "$(told "$job")"
for name in maps.exr albedo.png normal.png mask.png; do
    fetches "$job" "$name" got
    cmp -s got "own/$name" || complain "$name is another than merlin estimate's"
done
fetches "$job" viewer.html viewer.html
grep -q '"name":"cup"' viewer.html || complain "the viewer has no name"
asks 200 . "$site/v1/jobs/$job/files.zip"
if command -v unzip >/dev/null; then
    unzip -q body -d unzipped || complain "the archive is broken: $(unzip -t body | tail -3)"
    cmp -s unzipped/maps.exr own/maps.exr && cmp -s unzipped/viewer.html viewer.html || complain "the archive has other files"
else
    echo "no unzip here: the archive is not opened"
fi
asks 404 "no such job" "$site/v1/jobs/00000000000000000000000000000000/files.zip"
[[ -z $(ls -A tmp/merlin-serve-*/"$job"/in) ]] || complain "the upload stays: $(ls tmp/merlin-serve-*/"$job"/in)"

echo "a mask that was corrected is taken, also of another size"
small=$(submit mask -F photo=@"$demo" -F side=128)
fetches "$small" mask.png mask.png
painted=$(submit estimate -F photo=@"$demo" -F mask=@mask.png -F size=256 -F view=0 -F mesh=1)
told "$painted" | grep -q '"state":"done".*"mesh.glb"' || complain "a small mask: $(told "$painted")"
told "$painted" | grep -q viewer.html && complain "view=0 makes a viewer"

echo "pictures in other light are merlin relight's, of maps here, sent and made"
maps=$(submit estimate -F photo=@"$demo" -F view=0)
"$MERLIN" relight own --light 0.7,0.3,-0.4 -o relit -q
relit=$(submit relight -F job="$maps" -F light=0.7,0.3,-0.4)
fetches "$relit" relit.png got
cmp -s got relit/relit.png || complain "relight of a job is another than merlin relight's: $(told "$relit")"
relit=$(submit relight -F "maps=@own/maps.exr;filename=my maps.exr" -F light=0.7,0.3,-0.4 -F by=direct -F light=0,0,0)
told "$relit" | grep -q 'relit_000.png.*relit_001.png' || complain "two lights: $(told "$relit")"
"$MERLIN" relight own --light 0.7,0.3,-0.4 --no-bounces -o relit -q
fetches "$relit" relit_000.png got
cmp -s got relit/relit.png || complain "relight of maps that were sent is another than merlin relight's"
radiance room.hdr 32 6 64
relit=$(submit relight -F photo=@"$demo" -F environment=@room.hdr -F rotate=90 -F side=64)
told "$relit" | grep -q '"state":"done"' || complain "a room: $(told "$relit")"
"$MERLIN" relight own --direction 1,0.4,0.3 --power 2 --no-bounces -o relit -q
relit=$(submit relight -F job="$maps" -F direction=1,0.4,0.3,2 -F by=direct)
fetches "$relit" relit.png got
cmp -s got relit/relit.png || complain "a lamp far away is another than merlin relight's"
relit=$(submit relight -F job="$maps" -F light=0.7,0.3,-0.4,1,0.5,0.2 -F light=-1,0,0 -F together=1 -F by=direct)
told "$relit" | grep -q '"files":\[{"name":"relit.png"' || complain "two lamps at once: $(told "$relit")"
relit=$(submit relight -F job="$maps" -F orbit=3 -F side=64 -F by=direct)
told "$relit" | grep -q relit_002.png || complain "an orbit: $(told "$relit")"
asks 400 "one without the others" "$site/v1/relight" -F job="$maps" -F light=0,0,0 -F orbit=3
asks 400 "a power is 0 or more" "$site/v1/relight" -F job="$maps" -F light=0,0,0,-1
asks 400 'relight wants a light' "$site/v1/relight" -F job="$maps"
asks 400 'one of photo, maps' "$site/v1/relight" -F light=0,0,0
asks 400 'light wants 3 numbers' "$site/v1/relight" -F job="$maps" -F light=1,2
asks 404 'not there, or has no maps' "$site/v1/relight" -F job=00000000000000000000000000000000 -F light=0,0,0
asks 404 'not there, or has no maps' "$site/v1/relight" -F job=../../etc -F light=0,0,0
asks 404 'not there, or has no maps' "$site/v1/relight" -F job="$relit" -F light=0,0,0
for field in exposure=1 views=2 size=256 fov=40 flash=1 point=9,9 box=1,1,9,9 mask=@own/mask.png; do
    asks 400 "relight of maps takes no ${field%%=*}, which is of a photo" "$site/v1/relight" -F job="$maps" -F light=0,0,0 -F "$field"
done
asks 400 'rotate wants an environment' "$site/v1/relight" -F job="$maps" -F light=0,0,0 -F rotate=90
asks 400 'environment_exposure wants an environment' "$site/v1/relight" -F job="$maps" -F light=0,0,0 -F environment_exposure=1
asks 400 'together is of the lamps' "$site/v1/relight" -F job="$maps" -F environment=@room.hdr -F together=1
asks 400 'knows one lamp alone' "$site/v1/relight" -F job="$maps" -F light=0,0,0 -F light=1,0,0 -F together=1 -F by=network

echo "the report of pictures in other light has the command's warnings"
glare=$(submit relight -F job="$maps" -F light=0,0,0,1000 -F side=64)
told "$glare" | grep -q '"report":{"version":"[^"]*","schema":1,"warnings":\[.*"code":"relit_burnt_out".*"by":"brdf","model":"merlin-point","burnt_out":[01]' ||
    complain "no word of glare: $(told "$glare")"
glare=$(submit relight -F job="$maps" -F light=0,0,-3 -F side=64 -F by=direct)
told "$glare" | grep -q '"code":"nothing_lit"' || complain "no word of darkness: $(told "$glare")"
unmapped=$(submit relight -F maps=@"$demo" -F light=0,0,0)
told "$unmapped" | grep -q '"state":"failed".*maps.exr' || complain "a picture in the place of maps: $(told "$unmapped")"

echo "a surface over HTTP is merlin stereo's"
"$MERLIN" relight own --dome 12 --lp -o dome -q
"$MERLIN" stereo dome -o surface -q || complain "no surface"
pictures=()
for picture in dome/dome_*; do pictures+=(-F pictures=@"$picture"); done
solid=$(submit stereo "${pictures[@]}" -F lights=@dome/dome.lp -F mask=@dome/mask.webp)
told "$solid" | grep -q '"state":"done".*"method":"robust"' || complain "stereo: $(told "$solid")"
for name in maps.exr normal.png albedo.png; do
    fetches "$solid" $name got
    cmp -s got surface/$name || complain "$name is another than merlin stereo's"
done
fetches "$solid" viewer.html got
"$MERLIN" relight surface --light 0.7,0.3,-0.4 --no-bounces -o relit -q
relit=$(submit relight -F job="$solid" -F light=0.7,0.3,-0.4 -F by=direct)
fetches "$relit" relit.png got
cmp -s got relit/relit.png || complain "a surface relit is another than merlin relight's"
fetches "$solid" mesh.glb got
cmp -s got surface/mesh.glb || complain "the mesh is another than merlin stereo's"
"$MERLIN" stereo dome --method universal -o together -q || complain "no maps of pictures without lights"
together=$(submit stereo "${pictures[@]}" -F mask=@dome/mask.webp)
told "$together" | grep -q '"state":"done".*"photographs":12.*"refined":true' || complain "stereo without lights: $(told "$together" | head -c 900)"
for name in maps.exr normal.png albedo.png mesh.glb; do
    fetches "$together" $name got
    cmp -s got together/$name || complain "$name of pictures without lights is another than merlin stereo's"
done
fetches "$together" viewer.html got
two=$(submit stereo "${pictures[@]:0:4}" -F size=64 -F views=1)
told "$two" | grep -q '"state":"done".*"photographs":2' || complain "two pictures without lights: $(told "$two" | head -c 900)"
distant=$(submit stereo "${pictures[@]}" -F lights=@dome/dome.lp -F method=nfps)
told "$distant" | grep -q '"state":"failed".*nfps needs light positions' || complain "nfps of distant lights: $(told "$distant" | head -c 500)"
asks 400 'views is for a photo, or pictures without lights' "$site/v1/stereo" "${pictures[@]}" -F lights=@dome/dome.lp -F views=1
asks 400 'method universal takes no lights' "$site/v1/stereo" "${pictures[@]}" -F lights=@dome/dome.lp -F method=universal
asks 400 'is for pictures, not for a photo' "$site/v1/stereo" -F photo=@"$demo" -F method=universal
"$MERLIN" stereo "$demo" -o relit_surface -q || complain "no surface of a photograph"
single=$(submit stereo -F photo=@"$demo")
told "$single" | grep -q '"state":"done"' || complain "stereo of a photograph: $(told "$single" | head -c 500)"
fetches "$single" normal.png got
cmp -s got relit_surface/normal.png || complain "stereo of a photograph is another than merlin stereo's"
asks 400 'stereo of a photo knows no field' "$site/v1/stereo" -F photo=@"$demo" -F lights=@dome/dome.lp
asks 400 'has the methods auto, near and uncalibrated' "$site/v1/stereo" -F photo=@"$demo" -F method=ls
asks 400 'takes no lights and no near' "$site/v1/stereo" "${pictures[@]}" -F lights=@dome/dome.lp -F method=uncalibrated
asks 400 'stereo wants 3 pictures or more, not 2' "$site/v1/stereo" "${pictures[@]:0:4}" -F lights=@dome/dome.lp
asks 400 'filenames.txt, sent as pictures, has no name of a picture' "$site/v1/stereo" "${pictures[@]}" -F "pictures=@dome/dome.lp;filename=filenames.txt"
fewer=$(submit stereo "${pictures[@]:0:12}" -F lights=@dome/dome.lp)
told "$fewer" | grep -q '"state":"failed".*but what was sent has no such pictures, or several' || complain "missing pictures: $(told "$fewer" | head -c 500)"
cp "$demo" secret.png
sed "s|^[^ ]*\.[a-z]* |$PWD/secret.png |" dome/dome.lp >elsewhere.lp
elsewhere=$(submit stereo "${pictures[@]}" -F lights=@elsewhere.lp)
told "$elsewhere" | grep -q '"state":"failed"' || complain "a list that names other files is followed: $(told "$elsewhere" | head -c 500)"

echo "what was sent is checked at once"
asks 400 'no file \\"photo\\" was sent' "$site/v1/estimate" -F size=512
asks 400 'size wants a multiple of 32, not 100' "$site/v1/estimate" -F photo=@"$demo" -F size=100
asks 400 'views wants a whole number from 1 to 8' "$site/v1/estimate" -F photo=@"$demo" -F views=1e9
asks 400 'knows no field \\"colour\\"' "$site/v1/estimate" -F photo=@"$demo" -F colour=red
asks 400 'photo is given 2 times' "$site/v1/estimate" -F photo=@"$demo" -F photo=@"$demo"
asks 400 'photo of estimate is a value\|its part needs a filename' "$site/v1/estimate" -F photo=text
asks 400 'point wants 2 numbers' "$site/v1/estimate" -F photo=@"$demo" -F point=nan,3
asks 400 'no multipart' "$site/v1/estimate" -H 'Content-Type: text/plain' -d photo
asks 404 'no such thing' "$site/v1/paint" -F photo=@"$demo"
asks 405 'this takes GET, HEAD alone' -X PUT "$site/v1/status"
grep -qi '^allow: GET, HEAD.$' head || complain "no Allow: $(cat head)"
asks 405 'this takes GET, HEAD alone' "$site/v1/status" -F photo=@"$demo"
asks 405 'this takes GET, HEAD alone' -X GE "$site/v1/status"
asks 405 'this takes POST alone' "$site/v1/estimate"
asks 405 'this takes POST alone' -X DELETE "$site/v1/estimate"
asks 405 'this takes GET, HEAD, DELETE alone' -X POST "$site/v1/jobs/$solid"
asks 405 'this takes GET, HEAD alone' -X DELETE "$site/v1/jobs/$solid/files.zip"
asks 405 'this takes POST alone' -X OPTIONS -H "Origin: $site" "$site/v1/estimate"
asks 403 other_site -X OPTIONS -H "Origin: http://example.org" "$site/v1/estimate"
grep -qi 'access-control' head && complain "other sites' pages are let in"

echo "what is no picture fails with a word, without the server's folders"
wrong=$(submit estimate -F photo=@"$MERLIN_SOURCE_DIR/README.md")
told "$wrong" | grep -q '"state":"failed".*"error":".*README.md' || complain "$(told "$wrong")"
told "$wrong" | grep -q "$scratch" && complain "the server's folder is told: $(told "$wrong")"

echo "names that clients send are never paths"
for name in ../../escaped.png /tmp/escaped.png '..\escaped.png' .escaped.png 'a/../../escaped.png'; do
    job=$(submit estimate -F "photo=@$demo;filename=\"$name\"" -F size=64 -F views=1 -F view=0)
    told "$job" | grep -q '"state":"done"' || complain "$name: $(told "$job")"
done
find "$scratch" /tmp -maxdepth 3 -name '*escaped*' 2>/dev/null | grep -q . && complain "a file escaped"
for name in ../../lock ../in/demo.png %2e%2e/%2e%2e/lock ..%2f..%2flock /etc/passwd .; do
    asks 404 'no such thing' --path-as-is "$site/v1/jobs/$job/files/$name"
done
asks 404 'no such job' --path-as-is "$site/v1/jobs/../../etc/passwd"
asks 404 'no such job' "$site/v1/jobs/00000000000000000000000000000000"

echo "other sites' pages, and names that were made to point here, are refused"
for host in evil.example "evil.example:$port" 127.0.0.1 "127.0.0.1:1" "localhost.evil.example:$port" "[::1" ''; do
    asks 403 'wrong_host' -H "Host: $host" "$site/v1/status"
done
raw "GET /v1/status HTTP/1.0\r\n\r\n" | grep -q '40[03]' || complain "a request without Host is answered"
for host in "localhost:$port" "LOCALHOST:$port" "[::1]:$port"; do asks 200 version -H "Host: $host" "$site/v1/status"; done
for origin in http://evil.example null "http://127.0.0.1:1" "http://127.0.0.1:$port.evil.example" "file://127.0.0.1:$port"; do
    asks 403 'other_site' -H "Origin: $origin" "$site/v1/estimate" -F photo=@"$demo"
    asks 403 'other_site' -H "Origin: $origin" -X DELETE "$site/v1/jobs/$job"
done
asks 403 'other_site' -H 'Sec-Fetch-Site: cross-site' "$site/v1/status"
asks 403 'other_site' -H 'Sec-Fetch-Site: same-site' "$site/v1/status"
asks 200 '<title>merlin' -H 'Sec-Fetch-Site: cross-site' "$site/"
grep -qi "content-security-policy: default-src 'none'.*frame-ancestors 'none'" head || complain "the page has no policy"
asks 200 version -H "Origin: $site" -H 'Sec-Fetch-Site: same-origin' "$site/v1/status"

echo "a job that is not wanted goes, with its files"
asks 204 '' -X DELETE "$site/v1/jobs/$job"
asks 404 'no such job' "$site/v1/jobs/$job"
[[ ! -e $(echo tmp/merlin-serve-*/"$job") ]] || complain "its files stay"
asks 202 "queued\|working" "$site/v1/estimate" -F photo=@"$demo"
first=$(identifier <body)
asks 202 '"state":"queued","position":[12]' "$site/v1/estimate" -F photo=@"$demo"
second=$(identifier <body)
for early in files.zip files/maps.exr; do
    asks 409 '"code":"not_done","error":"the job is not done' "$site/v1/jobs/$second/$early"
    asks 409 '"code":"not_done","error":"the job failed' "$site/v1/jobs/$wrong/$early"
done
asks 409 '"code":"not_done"' "$site/v1/relight" -F job="$second" -F light=0,0,0
asks 204 '' -X DELETE "$site/v1/jobs/$first"
asks 204 '' -X DELETE "$site/v1/jobs/$second"

echo "the interface describes itself"
asks 200 '"openapi": "3' "$site/v1/openapi.json"
cmp -s body "$MERLIN_SOURCE_DIR/docs/openapi.json" || complain "the description is another than docs/openapi.json"

echo "a server for other machines tells addresses that they can call"
"$MERLIN" serve --host 0.0.0.0 --name studio.lan --port 0 --json >other.txt 2>other.err &
other=$!
for _ in {1..600}; do grep -q address other.txt && break; sleep 0.1; done
grep -q '"address":"http://studio.lan:[0-9]*/?token=[0-9a-f]*","addresses":\["http://studio.lan:' other.txt || complain "no address: $(cat other.txt other.err)"
grep -q '0\.0\.0\.0' other.txt && complain "nobody can call 0.0.0.0: $(cat other.txt)"
kill "$other" && wait "$other"

echo "a server that is told to end while it works ends, and leaves nothing"
asks 202 "queued\|working" "$site/v1/estimate" -F photo=@"$demo"
server_end TERM
finish
