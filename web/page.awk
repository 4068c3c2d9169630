# SPDX-License-Identifier: MIT
# Puts a page together: index.html with the style, the shaders and the modules in it.
#
#     awk -f web/page.awk -v folder=web -v out=page.html
#     awk -f web/page.awk -v folder=web -v out=view_page.c     as src/view/view_page.h declares it
#     awk -f web/page.awk -v folder=web/serve -v header=serve/serve_texts.h -v name=serve_page -v out=serve_page.c
#
# Another page than index.html is named by -v page_file=NAME. A line <!--part FILE--> stands for that file, which pages share.
#
# Each module becomes a function that gives back what it exports, those first that others import, so that names are the
# module's own. Imports and exports stand at the beginning of a line, an export before what it exports.

function fail(words) {
    print "page.awk: " words >"/dev/stderr"
    failed = 1
    exit 1
}

# Comments that have lines of their own are for the repository's readers.
function read(name,    line, text, got) {
    while ((got = (getline line <(folder "/" name))) > 0)
        if (name !~ /\.(js|glsl)$/ || line !~ /^ *\/\//) text = text line "\n"
    if (got < 0) fail("cannot read " folder "/" name)
    close(folder "/" name)
    return text
}

function shaders(    list, name, source, text) {
    list = "ls " folder "/shaders"
    text = "const shaders = {\n"
    while ((list | getline name) > 0) {
        source = read("shaders/" name)
        if (source ~ /[`\\$]/) fail("shaders/" name ": a character that a template string takes for its own")
        text = text "\"" name "\": `\n" source "`,\n"
    }
    close(list)
    return text "};\n"
}

function module(name,    lines, n, i, line, words, body, exported, before) {
    if (name in seen) return ""
    seen[name] = 1
    if (name == "shaders.js") return shaders()
    n = split(read(name), lines, "\n")
    for (i = 1; i < n; i++) {
        line = lines[i]
        if (line ~ /^import .* from "\.\/[a-z_]+\.js";$/) {
            match(line, /[a-z_]+\.js/)
            before = before module(substr(line, RSTART, RLENGTH))
            continue
        }
        if (line ~ /^(import|export \{)/) fail(name ": " line)
        if (sub(/^export /, "", line)) {
            words = line
            sub(/^(async )?(function|class|const|let) /, "", words)
            # of const A = 1, B = 2; both
            if (line ~ /^const .*;$/ && line !~ /[({]/)
                while (match(words, /[A-Za-z_]+ = /)) {
                    exported = exported substr(words, RSTART, RLENGTH - 3) ", "
                    words = substr(words, RSTART + RLENGTH)
                }
            else {
                match(words, /^[A-Za-z_0-9]+/)
                exported = exported substr(words, 1, RLENGTH) ", "
            }
        }
        body = body line "\n"
    }
    return before (exported ? "const { " substr(exported, 1, length(exported) - 2) " } = " : "") \
        "(() => {\n" body (exported ? "return { " substr(exported, 1, length(exported) - 2) " };\n" : "") "})();\n\n"
}

# Text with something else in the place of a character.
function replaced(text, what, by,    parts, n, i, whole) {
    n = split(text, parts, what)
    whole = parts[1]
    for (i = 2; i <= n; i++) whole = whole by parts[i]
    return whole
}

# One line of the page, or of C: with a compiler that knows trigraphs two question marks are no two question marks.
function put(line) {
    if (!is_c) print line >out
    else if (line == "<!--scene-->") print "    0,\n};\n\nconst char *const view_page_tail[] = {" >out
    else print "    \"" replaced(replaced(replaced(line, "[\\\\]", "\\\\"), "[\"]", "\\\""), "[?]", "\\?") "\"," >out
}

function put_lines(text,    lines, n, i) {
    n = split(text, lines, "\n")
    for (i = 1; i < n; i++) put(lines[i])
}

BEGIN {
    is_c = out ~ /\.c$/
    if (!header) header = "view/view_page.h"
    if (!name) name = "view_page_head"
    if (!page_file) page_file = "index.html"
    if (is_c) print "/* Made by web/page.awk. */\n#include \"" header "\"\n\nconst char *const " name "[] = {" >out
    n = split(read(page_file), page, "\n")
    for (i = 1; i < n; i++) {
        line = page[i]
        if (line == "/*style*/") put_lines(read("style.css"))
        else if (line ~ /^<!--part .*-->$/) put_lines(read(substr(line, 10, length(line) - 12)))
        else if (line == "/*script*/") put_lines(module("main.js"))
        else put(line)
    }
    if (is_c) print "    0,\n};" >out
    exit failed
}
