/* SPDX-License-Identifier: MIT */
#include "base/plain_locale.h"

#include <pthread.h>

static pthread_once_t once = PTHREAD_ONCE_INIT;
static locale_t plain;

static void make(void)
{
    plain = newlocale(LC_ALL_MASK, "C", (locale_t)0); /* built into the C library, so that it cannot fail */
}

locale_t plain_locale(void)
{
    pthread_once(&once, make);
    return plain;
}
