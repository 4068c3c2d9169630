/* SPDX-License-Identifier: MIT */
#include "command/options.h"

#include <assert.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/threads.h"
#include "command/cli.h"
#include "command/suggest.h"

enum { FIRST_LONG = 256, LETTERS = 2 * CLI_MOST_OPTIONS + 2 };

static status take_threads(const char *text, void *into)
{
    long count = 0;
    (void)into;
    status s = cli_int("--threads", text, 1, THREADS_MOST, &count);
    if (s != OK) return s;
    threads_use((int)count);
    (void)setenv("OMP_NUM_THREADS", text, 1); /* for the programs that merlin-lab bench starts */
    return OK;
}

/* Options of every command. */
static const cli_option common[] = {
    {"threads", 't', .take = take_threads},
    {0},
};

/* Joins a command's own and the common ones in a table of CLI_MOST_OPTIONS rows and an empty one. */
static void join(const cli_option *own, cli_option *all)
{
    size_t n = 0;
    for (; own->name; own++) {
        assert(n < CLI_MOST_OPTIONS);
        all[n++] = *own;
    }
    for (const cli_option *o = common; o->name; o++) {
        assert(n < CLI_MOST_OPTIONS);
        all[n++] = *o;
    }
    all[n] = (cli_option){0};
}

static int arguments_of(const cli_option *o)
{
    return o->is_value ? optional_argument : o->flag ? no_argument : required_argument;
}

/* Makes getopt_long's tables. Letters with values are followed by a colon; a colon in front distinguishes a missing
 * value from an unknown option. */
static void describe(const cli_option *options, struct option *longs, char *letters)
{
    size_t n = 0;
    *letters++ = ':';
    for (; options[n].name; n++) {
        const cli_option *o = &options[n];
        longs[n] = (struct option){.name = o->name, .has_arg = arguments_of(o), .val = FIRST_LONG + (int)n};
        if (!o->letter) continue;
        *letters++ = o->letter;
        if (!o->flag) *letters++ = ':';
    }
    *letters = 0;
    longs[n] = (struct option){0};
}

static const cli_option *find(const cli_option *options, int value)
{
    if (value >= FIRST_LONG) return &options[value - FIRST_LONG];
    while (options->letter != value)
        options++;
    return options;
}

/* Tells whether an abbreviation such as "--m" fits several options. */
static bool is_ambiguous(const cli_option *options, const char *given)
{
    size_t length = strcspn(given, "="), matches = 0;
    for (; options->name; options++)
        matches += length > 2 && strncmp(given + 2, options->name, length - 2) == 0;
    return matches > 1;
}

static status refuse_unknown(const cli_option *options, const char *given)
{
    const char *names[CLI_MOST_OPTIONS];
    size_t count = 0;
    for (; options->name; options++)
        names[count++] = options->name;
    const char *meant = suggest(given + 2, strcspn(given + 2, "="), names, count);
    return meant ? fail(MERLIN_WRONG_USE, "unknown option %s: did you mean --%s?", given, meant)
                 : fail(MERLIN_WRONG_USE, "unknown option %s", given);
}

/* Reports what getopt_long did not accept, given its result. It returns a letter; a long option is the argument before.
 */
static status refuse(const cli_option *options, int value, char *const *argv)
{
    char letter[] = {'-', (char)optopt, 0};
    bool is_letter = optopt > ' ' && optopt < 127, is_long = optopt == 0 || optopt >= FIRST_LONG;
    const char *given = is_letter ? letter : is_long ? argv[optind - 1] : "that is no letter";
    if (value == ':') return fail(MERLIN_WRONG_USE, "%s wants a value", given);
    if (optopt >= FIRST_LONG) return fail(MERLIN_WRONG_USE, "%s: this option takes no value", given);
    if (is_long && is_ambiguous(options, given))
        return fail(MERLIN_WRONG_USE, "%s is short for several options", given);
    return is_long ? refuse_unknown(options, given) : fail(MERLIN_WRONG_USE, "unknown option %s", given);
}

static status take_number(const cli_option *o, const char *value)
{
    char spelled[64];
    snprintf(spelled, sizeof spelled, "--%s", o->name);
    double real = 0;
    long whole = 0;
    if (o->real) {
        status s = cli_float(spelled, value, (double)o->low, (double)o->high, &real);
        if (s == OK) *o->real = (float)real;
        return s;
    }
    status s = cli_int(spelled, value, o->low, o->high, &whole);
    if (s == OK && o->integer) *o->integer = (int)whole;
    if (s == OK && o->count) *o->count = (size_t)whole;
    if (s == OK && o->whole) *o->whole = (uint64_t)whole;
    return s;
}

/* Takes a folder; a picture's name is refused, as users who expect one file would get a folder of that name. */
static status take_folder(const cli_option *o, const char *value)
{
    static const char *const pictures[] = {".png",  ".jpg",  ".jpeg", ".exr", ".tif",
                                           ".tiff", ".webp", ".gif",  ".hdr", NULL};
    if (file_ends_in_any(value, pictures))
        return fail(MERLIN_WRONG_USE, "--%s names a folder for several files, but %s ends like a picture", o->name,
                    value);
    if (strcmp(value, "-") == 0 && !o->printed)
        return fail(MERLIN_WRONG_USE,
                    "--%s names a folder for several files, which standard output cannot hold; ./- is one "
                    "called -",
                    o->name);
    *o->folder = value;
    return OK;
}

/* Takes a picture's name and checks it before the work. */
static status take_picture(const cli_option *o, const char *value)
{
    if (!file_ends_in(value, ".png"))
        return fail(MERLIN_WRONG_USE, "--%s names a picture to write, a PNG: let %s end in .png", o->name, value);
    *o->picture = value;
    return OK;
}

static status take(const cli_option *o, const char *value)
{
    if (o->take && value) return o->take(value, o->into);
    if (o->folder && value) return take_folder(o, value); /* getopt_long has refused a missing value */
    if (o->picture && value) return take_picture(o, value);
    if (o->flag)
        *o->flag = true;
    else if (o->text)
        *o->text = value;
    else
        return take_number(o, value);
    return OK;
}

/* Returns the value that getopt_long has found or, if a value may be missing, the next word, which it skips. */
static const char *value_of(const cli_option *o, int argc, char *const *argv)
{
    bool next = o->is_value && !optarg && optind < argc && o->is_value(argv[optind]);
    return next ? argv[optind++] : optarg;
}

status cli_read_options(int *argc, char ***argv, const cli_option *own)
{
    cli_option options[CLI_MOST_OPTIONS + 1];
    join(own, options);
    struct option longs[CLI_MOST_OPTIONS + 1];
    char letters[LETTERS];
    describe(options, longs, letters);
    opterr = 0;
    optind = 1;
    bool met[CLI_MOST_OPTIONS] = {false};
    for (int value; (value = getopt_long(*argc, *argv, letters, longs, NULL)) != -1;) {
        if (value == ':' || value == '?') return refuse(options, value, *argv);
        const cli_option *option = find(options, value);
        const char *given = value_of(option, *argc, *argv);
        if (given && !*given)
            return fail(MERLIN_WRONG_USE, "--%s wants a value", option->name); /* for example "$UNSET" */
        bool *before = &met[option - options];
        if (*before && !option->many && !option->flag)
            return fail(MERLIN_WRONG_USE, "--%s is given twice", option->name);
        *before = true;
        status s = take(option, given);
        if (s != OK) return s;
    }
    *argc -= optind;
    *argv += optind;
    return OK;
}
