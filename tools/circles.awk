# SPDX-License-Identifier: MIT
# Finds files that stand on each other, directly or through further ones, prints one circle of each such knot and then
# ends with 1.
#
#     find src include -name '*.[ch]' | xargs awk -f tools/circles.awk
#
# A file is NAME.c with NAME.h, or whichever of the two there is. It stands on each file whose header it includes and on
# each file whose functions or variables it names. So a header that several sources implement belongs to the source of
# its own name, or is a file by itself; the other sources stand on it like all who include it, and who calls their
# functions stands on them, too. Sources are taken to be formatted (make format): definitions begin a line.

# Without comments, and with 0 for texts.
function code_of(line,    code, mark)
{
    while (line != "") {
        if (in_comment) {
            if (!(mark = index(line, "*/"))) return code
            line = substr(line, mark + 2)
            in_comment = 0
        }
        if (!match(line, /"([^"\\]|\\.)*"|'([^'\\]|\\.)*'|\/\*|\/\//)) return code line
        code = code substr(line, 1, RSTART - 1)
        mark = substr(line, RSTART, 2)
        line = substr(line, RSTART + RLENGTH)
        if (mark == "//") return code
        if (mark == "/*") in_comment = 1
        else code = code "0"
    }
    return code
}

# What a line that begins in its first column declares or defines; "" if nothing.
function name_of(code)
{
    if (code !~ /^[a-z]/ || code ~ /^(typedef|struct|enum|union)/) return ""
    if (match(code, /[a-z_0-9]+\(/)) return substr(code, RSTART, RLENGTH - 1)
    sub(/ *[=;[].*/, "", code)
    sub(/.*[ *]/, "", code)
    return code
}

# All words are, of which only those matter that some source defines: a line may have several variables.
function declare(code)
{
    while (match(code, /[a-z_][a-z_0-9]*/)) {
        declared[substr(code, RSTART, RLENGTH)] = 1
        code = substr(code, RSTART + RLENGTH)
    }
}

function file_of(path,    source)
{
    source = path
    sub(/\.h$/, ".c", source)
    return source in has ? source : path
}

FNR == 1 {
    path = FILENAME
    sub(/^(src|include)\//, "", path)
    paths[++path_count] = path
    has[path] = 1
    is_header = path ~ /\.h$/
    in_comment = 0
}

/^#include "/ {
    split($0, part, "\"")
    includes[path] = includes[path] part[2] " "
    next
}

{
    code = code_of($0)
    name = name_of(code)
    if (name != "") {
        pending = ""
        if (code ~ /^static/) own[path, name] = 1
        else if (is_header) declare(code)
        else if (code ~ /\(/ && code !~ /=/) pending = name
        else source_of[name] = path
    } else if (code == "{" && pending != "") {
        source_of[pending] = path
    }
    if (is_header && name != "" && code !~ /^static/) next
    while (match(code, /[A-Za-z_][A-Za-z_0-9]*/)) {
        if (substr(code, 1, RSTART - 1) !~ /(\.|->)$/) words[path, substr(code, RSTART, RLENGTH)] = 1
        code = substr(code, RSTART + RLENGTH)
    }
}

function stand(lower, upper, why)
{
    if (lower == upper || (upper, lower) in reason) return
    reason[upper, lower] = why
    below[upper] = below[upper] lower " "
}

# Tarjan's strongly connected components: knot[file] is the first file of the file's own.
function visit(file,    list, count, i, at)
{
    lowest[file] = number[file] = ++numbers
    stack[++depth] = file
    count = split(below[file], list, " ")
    for (i = 1; i <= count; i++) {
        at = list[i]
        if (!(at in number)) visit(at)
        if (!(at in knot) && lowest[at] < lowest[file]) lowest[file] = lowest[at]
    }
    if (lowest[file] != number[file]) return
    if (stack[depth] != file) tied[file] = 1
    do {
        at = stack[depth--]
        knot[at] = file
    } while (at != file)
}

# The shortest way from a file through its knot back to it.
function print_circle(start,    queue, first, last, list, count, i, at, from, lines)
{
    queue[last = 1] = start
    for (first = 1; !(start in from); first++) {
        count = split(below[queue[first]], list, " ")
        for (i = 1; i <= count; i++) {
            if (knot[list[i]] != knot[start] || list[i] in from) continue
            from[list[i]] = queue[first]
            queue[++last] = list[i]
        }
    }
    at = start
    do {
        lines = "    " from[at] " " reason[from[at], at] "\n" lines
        at = from[at]
    } while (at != start)
    printf "files stand on each other:\n%s", lines
}

END {
    for (i = 1; i <= path_count; i++) {
        count = split(includes[paths[i]], list, " ")
        for (j = 1; j <= count; j++)
            if (list[j] in has) stand(file_of(list[j]), file_of(paths[i]), "includes " list[j])
    }
    for (key in words) {
        split(key, part, SUBSEP)
        if (part[2] in source_of && part[2] in declared && !(key in own))
            stand(source_of[part[2]], file_of(part[1]), "names " part[2] " of " source_of[part[2]])
    }
    for (i = 1; i <= path_count; i++)
        if (!(file_of(paths[i]) in number)) visit(file_of(paths[i]))
    for (i = 1; i <= path_count; i++) {
        if (!(paths[i] in tied)) continue
        print_circle(paths[i])
        failed = 1
    }
    exit failed
}
