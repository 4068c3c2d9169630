/* SPDX-License-Identifier: MIT */
#include "serve/http/addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

static void add(const char *host, addresses *out)
{
    if (out->count == ADDRESSES_MOST) return;
    const bool is_v6 = strchr(host, ':') != NULL;
    snprintf(out->at[out->count++], ADDRESSES_HOST, is_v6 ? "[%s]" : "%s", host);
}

/* Adds the address of a network, unless no other machine can call it without more than this. */
static void add_network(const struct ifaddrs *network, bool v6, addresses *out)
{
    char text[INET6_ADDRSTRLEN];
    const struct sockaddr *at = network->ifa_addr;
    if (!at || !(network->ifa_flags & IFF_UP) || network->ifa_flags & IFF_LOOPBACK) return;
    if (at->sa_family == AF_INET) {
        struct sockaddr_in number;
        memcpy(&number, at, sizeof number);
        if (inet_ntop(AF_INET, &number.sin_addr, text, sizeof text)) add(text, out);
    } else if (v6 && at->sa_family == AF_INET6) {
        struct sockaddr_in6 number;
        memcpy(&number, at, sizeof number);
        if (IN6_IS_ADDR_LINKLOCAL(&number.sin6_addr)) return;
        if (inet_ntop(AF_INET6, &number.sin6_addr, text, sizeof text)) add(text, out);
    }
}

/* Tells whether a host's address stands for all of a machine's. */
static bool is_any(const char *host, bool *v6)
{
    struct in_addr four;
    struct in6_addr six;
    *v6 = inet_pton(AF_INET6, host, &six) == 1;
    if (*v6) return IN6_IS_ADDR_UNSPECIFIED(&six);
    return inet_pton(AF_INET, host, &four) == 1 && four.s_addr == htonl(INADDR_ANY);
}

void addresses_list(const char *host, const char *const *names, addresses *out)
{
    struct ifaddrs *networks = NULL;
    bool v6;
    *out = (addresses){.count = 0};
    if (!is_any(host, &v6)) {
        add(host, out);
        return;
    }
    for (; *names; names++)
        add(*names, out);
    if (getifaddrs(&networks) == 0) {
        for (const struct ifaddrs *n = networks; n; n = n->ifa_next)
            add_network(n, v6, out);
        freeifaddrs(networks);
    }
    if (out->count == 0) add(v6 ? "::1" : "127.0.0.1", out);
}
