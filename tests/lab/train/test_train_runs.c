/* SPDX-License-Identifier: MIT */
/* The files of configs/: a hash of what each run trains is recorded here, as editing a base file would change old runs
 * with it, whose checkpoints would then be refused and whose model cards would be wrong. */
#include <glob.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "lab/train/config/train_config.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define CONFIGS MERLIN_SOURCE_DIR "/configs/"

/* Hashes are FNV-1a of the network and the training as checkpoints store them; those of the first 38 are of files that
 * had everything in one. The number type is not included, as "auto" depends on the machine. */
static const struct run {
    const char *name;
    uint64_t mark;
} runs[] = {
    {"merlin-point/01-128", 0xc6743b49f9a27d2d},
    {"merlin-point/02-depth-128", 0x434240bf764a4c21},
    {"merlin-point/03-long-128", 0x5f48ed34b17bd01f},
    {"merlin-point/04-256", 0x83a5c4ca000cdcc3},
    {"merlin-point/05-more-128", 0x0f7996b1d76f3630},
    {"merlin-point/06-more-256", 0xfae55f5ef2b42698},
    {"merlin-point/09-mean-128", 0xbaa85e06c551076e},
    {"merlin-point/10-mean-256", 0x76b0fb563203f338},
    {"merlin-point/12-brdf-256", 0x00ef2f9eb0c0dfe6},
    {"merlin-point/13-ssim-256", 0x9bf62bb57cecb8b2},
    {"merlin-point/15-deep-128", 0x65c6709173172131},
    {"merlin-point/16-deep-256", 0x80a8e7e83afe3f10},
    {"merlin-point/17-fine-128", 0x98d719e6047660d4},
    {"merlin-point/18-fine-256", 0xf4d1463f23b6d1d2},
    {"merlin-point/19-sharp-128", 0xf4ecf26f0ef1f2c9},
    {"merlin-point/20-sharp-256", 0x8941b8ae311a1d1b},
    {"merlin-point/23-albedo-128", 0x4c1d8c57f07c6fbb},
    {"merlin-point/24-albedo-256", 0xbe0780b7ac42aa19},
    {"merlin-env/01-128", 0xd5b4527deb9aeb09},
    {"merlin-env/02-256", 0x39c0836866e772fc},
    {"merlin-env/04-more-128", 0x0a842395ff51fcb3},
    {"merlin-env/05-more-256", 0x14fc9474aea91b4f},
    {"merlin-env/06-fine-128", 0x74a8fd0d1845015d},
    {"merlin-env/07-fine-256", 0x7dfc90c9283bf84a},
    {"merlin-env/08-sharp-128", 0x3c8071ab255ad23d},
    {"merlin-env/09-sharp-256", 0x69dbc553a3c3ba5d},
    {"merlin-any/01-96", 0x80397c32596b693c},
    {"merlin-any/02-more-96", 0xa3be8cb7a2d4e336},
    {"merlin-any/03-256", 0x64a4ad2d9ecfead2},
    {"merlin-any/04-fresh-256", 0x2d9fd6d96df4ee11},
    {"merlin-any/05-fresh-256", 0x59383e2a8dce34a7},
    {"merlin-any/06-fresh-256", 0xbc3bf35512299692},
    {"merlin-several/01-96", 0x4d79aecd24ccd6b1},
    {"merlin-several/02-96", 0xa9a8f6e47c604943},
    {"merlin-several/03-96", 0xe8f4309d85415aa3},
    {"merlin-several/04-96", 0x3861fd79b97fd1dc},
    {"merlin-lights/01-96", 0x9b37bc59f24fbc72},
    {"merlin-lights/02-96", 0x3e76aa8b4d21b5ed},
    {"merlin-lights/03-96", 0x7202ec769df06ded},
    {"merlin-nfps/03-64", 0xe0bee88420cd9c30},
    {"merlin-nfps/02-64", 0xfe7f5caa2d4bdd4f},
    {"merlin-nfps/01-64", 0x1ac1ae3ab8f51692},
    {"table1/9", 0x4660fbca9884cbde},
    {"table1/1", 0xcf5e31d3872ff4a9},
    {"table1/2", 0x92a1542ea74650c5},
    {"table1/3", 0xb1505756b57901c6},
    {"table1/4", 0xbcb1cd40e6fd2043},
    {"table1/5", 0x42686fd850f8a4af},
    {"table1/6", 0x6f6c0c471779f44b},
    {"table1/7", 0x2ec51ce69298f93f},
    {"table1/8", 0x9181f3473d1b2dcc},
    {"table2/li-arithmetic", 0xf9c4e528d9231d03},
    {"table2/sang-arithmetic", 0x2a4ceebc70a492be},
    {"table2/li", 0x4890f3c8ad78d028},
    {"table2/sang", 0xf699d3c05d61d008},
    {"merlin-any/07-128", 0xf269b25598af5e61},
    {"merlin-any/08-256", 0x931749a8ca7c454c},
    {"merlin-any/09-128", 0x1de0d96206db84d7},
    {"merlin-any/10-256", 0x8465c7b5d22c5a02},
    {"merlin-any/11-128", 0xfe26dda258a028c9},
    {"merlin-any/12-256", 0xedec69fba1d8cd03},
    {"merlin-any/13-128", 0x4e31cd54213af74d},
    {"merlin-any/14-256", 0x56e84429cefd1f20},
    {"merlin-any/15-256", 0xbf9cf71be92e9e4e},
};
enum { RUNS = sizeof runs / sizeof *runs };

static void read_run(const char *name, model_config *m, train_config *t)
{
    char path[512];
    snprintf(path, sizeof path, "%sruns/%s.json", CONFIGS, name);
    if (train_config_read(path, m, t) != OK) fail_msg("%s", status_message());
}

static uint64_t mark_on(uint64_t mark, const char *text)
{
    for (; *text; text++)
        mark = (mark ^ (unsigned char)*text) * UINT64_C(0x100000001b3);
    return mark;
}

static void every_run_trains_what_it_did(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < RUNS; i++) {
        model_config m;
        train_config t;
        read_run(runs[i].name, &m, &t);
        t.type = NN_FLOAT32;
        char *model = model_config_write(&m), *training = train_config_write(&t);
        assert_true(model && training);
        uint64_t mark = mark_on(mark_on(UINT64_C(0xcbf29ce484222325), model), training);
        if (mark != runs[i].mark)
            fail_msg("%s is another now, 0x%016" PRIx64 ": %s, %s", runs[i].name, mark, model, training);
        free(model);
        free(training);
    }
}

static bool is_known(const char *path)
{
    for (size_t i = 0; i < RUNS; i++) {
        size_t length = strlen(runs[i].name);
        if (strncmp(path + strlen(CONFIGS "runs/"), runs[i].name, length) == 0 &&
            strcmp(path + strlen(CONFIGS "runs/") + length, ".json") == 0)
            return true;
    }
    return false;
}

static void every_run_has_a_mark_and_can_be_measured(void **unused)
{
    (void)unused;
    glob_t files;
    assert_int_equal(glob(CONFIGS "runs/*/*.json", 0, NULL, &files), 0);
    assert_int_equal(files.gl_pathc, RUNS);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        model_config trained, alone;
        train_config t;
        if (!is_known(files.gl_pathv[i])) fail_msg("%s has no mark here", files.gl_pathv[i]);
        if (train_config_read(files.gl_pathv[i], &trained, &t) != OK) fail_msg("%s", status_message());
        if (model_config_read(files.gl_pathv[i], &alone) != OK) fail_msg("%s", status_message());
        assert_memory_equal(&trained, &alone, sizeof trained);
    }
    globfree(&files);
}

/* merlin-point-deep.json is an earlier, smaller merlin-point. */
static void every_network_can_be_read_and_has_its_files_name(void **unused)
{
    (void)unused;
    glob_t files;
    assert_int_equal(glob(CONFIGS "models/*.json", 0, NULL, &files), 0);
    assert_true(files.gl_pathc > 9);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        const char *name = file_name_of(files.gl_pathv[i]);
        model_config m;
        if (model_config_read(files.gl_pathv[i], &m) != OK) fail_msg("%s", status_message());
        size_t length = strlen(m.name);
        assert_int_equal(strncmp(name, m.name, length), 0);
        assert_true(name[length] == '-' || name[length] == '.');
        bool both = strncmp(name, "merlin-env", 10) == 0, any = strncmp(name, "merlin-any", 10) == 0 || m.several;
        /* table 1 is of the point setting, too */
        assert_int_equal(m.lighting, both ? MODEL_LIGHT_BOTH : any ? MODEL_LIGHT_ANY : MODEL_LIGHT_POINT);
    }
    globfree(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_run_trains_what_it_did),
        cmocka_unit_test(every_run_has_a_mark_and_can_be_measured),
        cmocka_unit_test(every_network_can_be_read_and_has_its_files_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
