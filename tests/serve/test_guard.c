/* SPDX-License-Identifier: MIT */
/* Whose requests are answered. */
#include "serve/http/guard.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const guard here = {.port = 8712, .local = true};
static const guard open_to_others = {
    .port = 8712, .names = {"studio.lan"}, .token = "0123456789abcdef0123456789abcdef"};

static guard_answer asked_by(const guard *g, const char *host)
{
    const guard_asked asked = {.host = host, .authorization = "Bearer 0123456789abcdef0123456789abcdef"};
    return guard_ask(g, &asked);
}

static void this_machine_is_asked_by_its_own_names_alone(void **state)
{
    static const char *const own[] = {"127.0.0.1:8712", "localhost:8712", "LocalHost:8712", "[::1]:8712"};
    static const char *const others[] = {"127.0.0.1",
                                         "127.0.0.1:80",
                                         "evil.example:8712",
                                         "127.0.0.2:8712",
                                         "127.0.0.1:8712:80",
                                         "127.0.0.1:8712@x",
                                         "",
                                         ":8712",
                                         "[::1",
                                         "[::1]x",
                                         "[]:8712",
                                         "localhost.:8712",
                                         "127.0.0.1:87120",
                                         "127.0.0.1:087120",
                                         "0x7f.0.0.1:8712",
                                         "studio.lan:8712",
                                         "127.0.0.1 :8712",
                                         "192.168.1.20:8712",
                                         "127.0.0.1:",
                                         "127.0.0.1:8712 "};
    (void)state;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        assert_int_equal(asked_by(&here, own[i]), GUARD_PASSES);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (asked_by(&here, others[i]) != GUARD_NO_HOST) fail_msg("\"%s\" passes", others[i]);
    assert_int_equal(asked_by(&here, NULL), GUARD_NO_HOST);
}

static void other_machines_ask_by_an_address_or_a_name_that_was_given(void **state)
{
    (void)state;
    assert_int_equal(asked_by(&open_to_others, "192.168.1.20:8712"), GUARD_PASSES);
    assert_int_equal(asked_by(&open_to_others, "[fe80::1]:8712"), GUARD_PASSES);
    assert_int_equal(asked_by(&open_to_others, "studio.lan"), GUARD_PASSES);
    assert_int_equal(asked_by(&open_to_others, "studio.lan:443"), GUARD_PASSES);
    assert_int_equal(asked_by(&open_to_others, "evil.example:8712"), GUARD_NO_HOST);
    assert_int_equal(asked_by(&open_to_others, "192.168.1.20:80"), GUARD_NO_HOST);
}

static guard_answer from(const char *origin, const char *site, bool is_page)
{
    const guard_asked asked = {.host = "localhost:8712", .origin = origin, .fetch_site = site, .is_page = is_page};
    return guard_ask(&here, &asked);
}

static void other_sites_pages_are_refused(void **state)
{
    (void)state;
    assert_int_equal(from(NULL, NULL, false), GUARD_PASSES);
    assert_int_equal(from("http://localhost:8712", "same-origin", false), GUARD_PASSES);
    assert_int_equal(from("https://localhost:8712", NULL, false), GUARD_PASSES);
    assert_int_equal(from(NULL, "none", false), GUARD_PASSES);
    assert_int_equal(from(NULL, "cross-site", true), GUARD_PASSES);
    assert_int_equal(from(NULL, "cross-site", false), GUARD_OTHER_SITE);
    assert_int_equal(from(NULL, "same-site", false), GUARD_OTHER_SITE);
    static const char *const others[] = {"null",
                                         "",
                                         "http://evil.example",
                                         "http://localhost:3000",
                                         "http://localhost",
                                         "http://127.0.0.1:8712",
                                         "http://localhost:8712.evil.example",
                                         "ftp://localhost:8712",
                                         "localhost:8712",
                                         "x://http://localhost:8712"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (from(others[i], NULL, true) != GUARD_OTHER_SITE) fail_msg("\"%s\" passes", others[i]);
}

static guard_answer with(const char *authorization, const char *cookie)
{
    const guard_asked asked = {.host = "studio.lan", .authorization = authorization, .cookie = cookie};
    return guard_ask(&open_to_others, &asked);
}

static void a_token_is_the_whole_token(void **state)
{
    (void)state;
    assert_int_equal(with("Bearer 0123456789abcdef0123456789abcdef", NULL), GUARD_PASSES);
    assert_int_equal(with("bearer 0123456789abcdef0123456789abcdef", NULL), GUARD_PASSES);
    assert_int_equal(with(NULL, "0123456789abcdef0123456789abcdef"), GUARD_PASSES);
    static const char *const wrong[] = {
        "",
        "Bearer ",
        "Bearer",
        "0123456789abcdef0123456789abcdef",
        "Basic 0123456789abcdef0123456789abcdef",
        "Bearer 0123456789abcdef",
        "Bearer 0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef",
        "Bearer 0123456789abcdef0123456789abcdeF",
        "Bearer 0123456789abcdef0123456789abcdef ",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (with(wrong[i], NULL) != GUARD_NO_TOKEN) fail_msg("\"%s\" passes", wrong[i]);
    assert_int_equal(with(NULL, NULL), GUARD_NO_TOKEN);
    assert_int_equal(with(NULL, ""), GUARD_NO_TOKEN);
    assert_int_equal(with(NULL, "0123456789abcdef"), GUARD_NO_TOKEN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(this_machine_is_asked_by_its_own_names_alone),
        cmocka_unit_test(other_machines_ask_by_an_address_or_a_name_that_was_given),
        cmocka_unit_test(other_sites_pages_are_refused),
        cmocka_unit_test(a_token_is_the_whole_token),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
