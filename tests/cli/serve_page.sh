#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin serve's page in a browser: photographs dropped, the mask painted, results seen and removed. Where Chromium is
# missing the test says so and is skipped.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/server.bash
source "$(dirname "$0")/support/server.bash"
# shellcheck source=tests/cli/support/browser.bash
source "$(dirname "$0")/support/browser.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
hands=$(cat "$(dirname "$0")/support/serve_hands.js")
cd "$scratch" || exit 1
cp "${MERLIN_SOURCE_DIR:?}/examples/demo.png" cup.png
server_start || exit 77
browser_start || {
    echo "skipped: there is no Chromium, so nobody looks at the page"
    server_end
    exit 77
}

echo "hands and keys do what the page says"
browser_open "$site/" 1200 900
browser_drop '#files' cup.png
browser_eval "(async () => { $hands
return await all(); })()" >said
grep -v '^ok' said && complain "the page does not do what it should"
[[ $(grep -c '^ok' said) -ge 24 ]] || complain "only $(grep -c '^ok' said) things were tried"

echo "narrow windows have all of it"
browser_call Emulation.setDeviceMetricsOverride '{"width":320,"height":640,"deviceScaleFactor":1,"mobile":true}'
wide=$(browser_eval '`${document.documentElement.scrollWidth}`')
[[ $wide -le 320 ]] || complain "the page is $wide pixels wide in a window of 320"
server_end

echo "a token in the address becomes a cookie, and the page works with it"
server_start --host 127.0.0.1
tries=0 address=$(sed 's/.*"address":"\([^"]*\)".*/\1/' server.txt)
browser_call Page.navigate "{\"url\":$(json_text "$address")}"
until [[ $(browser_eval 'document.readyState + location.href + (document.documentElement.dataset.ready === "")') == complete"$site/true" ]] || ((++tries == 300)); do sleep 0.1; done
[[ $(browser_eval 'location.href + document.getElementById("version").textContent + document.cookie') == "$site/merlin "[0-9.]* ]] ||
    complain "the page does not open by its token: $(browser_eval 'location.href + document.body.textContent')"
server_end
browser_end
finish
