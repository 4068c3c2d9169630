#include "image/start.h"

#include <gmodule.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vips/vips.h>

static pthread_once_t once = PTHREAD_ONCE_INIT;
static int started;

static void swallow(const gchar *domain, GLogLevelFlags level, const gchar *message, gpointer user)
{
    (void)domain;
    (void)level;
    (void)message;
    (void)user;
}

static void start(void)
{
    g_log_set_handler("VIPS", G_LOG_LEVEL_MASK, swallow, NULL);
    started = VIPS_INIT("merlin") == 0;
    vips_concurrency_set(1);
    vips_cache_set_max(0);
}

status vips_begin(void)
{
    pthread_once(&once, start);
    return started ? OK : fail(ERROR_DEVICE, "the image library libvips did not start: is it installed whole?");
}

void vips_without_modules(void)
{
    (void)setenv("VIPSHOME", "/nonexistent", 0); /* where it looks for them; whoever set it wants others */
}

bool vips_load_heif(void)
{
    char path[1024];
    snprintf(path, sizeof path, MERLIN_VIPS_LIBDIR "/vips-modules-%d.%d/vips-heif." G_MODULE_SUFFIX, vips_version(0),
             vips_version(1));
    GModule *module = g_module_open(path, G_MODULE_BIND_LAZY);
    if (module) g_module_make_resident(module); /* its types stay registered */
    return module != NULL;
}

status vips_refusal(status s, const char *verb, const char *path)
{
    char words[256];
    g_strlcpy(words, vips_error_buffer(), sizeof words);
    vips_error_clear();
    words[strcspn(words, "\r\n")] = 0;
    return fail(s, "cannot %s %s: %s", verb, path, words[0] ? words : "the image library does not say why");
}
