/* SPDX-License-Identifier: MIT */
#include "command/cli.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/messages.h"
#include "command/standard_input.h"

static volatile sig_atomic_t interrupted;

int cli_fail(const char *command, status s)
{
    char words[1024];
    standard_input_tell(status_message(), words, sizeof words);
    fprintf(messages(), "%s %s: %s\n", messages_program(), command, words);
    return s == MERLIN_WRONG_USE ? 2 : 1;
}

int cli_usage(const char *command, const char *format, ...)
{
    char message[512];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    const char *program = messages_program();
    fprintf(messages(), "%s %s: %s (try %s %s --help)\n", program, command, message, program, command);
    return 2;
}

int cli_refuse(const char *command, status s)
{
    return s == MERLIN_WRONG_USE ? cli_usage(command, "%s", status_message()) : cli_fail(command, s);
}

status cli_int(const char *option, const char *text, long low, long high, long *out)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end || errno || value < low || value > high)
        return fail(MERLIN_WRONG_USE, "%s wants a whole number from %ld to %ld, not \"%s\"", option, low, high, text);
    *out = value;
    return OK;
}

status cli_float(const char *option, const char *text, double low, double high, double *out)
{
    char *end;
    errno = 0;
    double value = strtod(text, &end);
    if (end == text || *end || errno || !(value >= low && value <= high))
        return fail(MERLIN_WRONG_USE, "%s wants a number from %g to %g, not \"%s\"", option, low, high, text);
    *out = value;
    return OK;
}

status cli_vec3(const char *option, const char *text, float out[3])
{
    const char *at = text;
    for (int i = 0; i < 3; i++) {
        char *end;
        errno = 0;
        float value = strtof(at, &end);
        if (end == at || errno || !isfinite(value) || *end != (i < 2 ? ',' : '\0'))
            return fail(MERLIN_WRONG_USE, "%s wants three numbers x,y,z, not \"%s\"", option, text);
        out[i] = value;
        at = end + 1;
    }
    return OK;
}

static void note_interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

void cli_catch_interrupts(void)
{
    /* a second signal ends the program at once, for users who press Ctrl-C twice */
    struct sigaction action = {.sa_handler = note_interrupt, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    /* a closed terminal, which shell and system may both signal; nohup has it ignored */
    struct sigaction hangup;
    sigaction(SIGHUP, NULL, &hangup);
    action.sa_flags = 0;
    if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
    /* a file that may not grow then causes a failed write with a message */
    signal(SIGXFSZ, SIG_IGN);
}

int cli_interrupted(void)
{
    return interrupted;
}
