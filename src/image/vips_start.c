/* SPDX-License-Identifier: MIT */
#include "image/vips_start.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "image/vips_library.h"

static pthread_once_t once = PTHREAD_ONCE_INIT;
static bool started;

static void swallow(const gchar *domain, GLogLevelFlags level, const gchar *message, gpointer user)
{
    (void)domain;
    (void)level;
    (void)message;
    (void)user;
}

static void start(void)
{
    bool first = vips()->g_type_from_name("VipsObject") == 0; /* its first class */
    if (first) vips()->g_log_set_handler("VIPS", G_LOG_LEVEL_MASK, swallow, NULL);
    started = vips()->init("merlin") == 0;
    if (!first) return;
    vips()->concurrency_set(1);
    vips()->cache_set_max(0);
}

/* Checks that there is memory and a thread to be had: GLib ends the program if it is refused either. */
static status check_room(void)
{
    static const size_t some = (size_t)64 << 20;
    enum { THREADS = 3 };
    if (!memory_is_left(some)) return fail(MERLIN_NO_MEMORY, "no memory for the image library " MERLIN_VIPS);
    if (!threads_are_left(THREADS)) return fail(MERLIN_NO_MEMORY, "no threads for the image library " MERLIN_VIPS);
    return OK;
}

status vips_begin(void)
{
    status s = vips_load();
    if (s == OK) s = check_room();
    if (s != OK) return s;
    pthread_once(&once, start);
    return started ? OK : fail(MERLIN_DEVICE_FAILED, "the image library " MERLIN_VIPS " did not start");
}

bool vips_load_heif(void)
{
    typedef const gchar *registration(void *module); /* what GModule, libvips' loader of modules, calls */
    char path[1024];
    snprintf(path, sizeof path, MERLIN_VIPS_LIBDIR "/vips-modules-%d.%d/vips-heif.so", vips()->version(0),
             vips()->version(1));
    void *module = dlopen(path, RTLD_LAZY | RTLD_LOCAL); /* never closed: its types stay registered */
    registration *begin = NULL;
    void *found = module ? dlsym(module, "g_module_check_init") : NULL;
    memcpy(&begin, &found, sizeof begin); /* ISO C has no conversion from data to function pointers */
    return begin && !begin(NULL);
}

status vips_refusal(status s, const char *verb, const char *path)
{
    char words[256];
    snprintf(words, sizeof words, "%s", vips()->error_buffer());
    vips()->error_clear();
    words[strcspn(words, "\r\n")] = 0;
    if (!words[0]) snprintf(words, sizeof words, "the image library does not say why");
    if (s != MERLIN_BAD_INPUT) return fail(s, "cannot %s %s: %s", verb, path, words);
    return fail(s, "cannot %s %s: it is damaged, cut short or of a variant that is not read here (%s); save it again",
                verb, path, words);
}
