/* SPDX-License-Identifier: MIT */
/* Training samples from arbitrary bytes, read whole and as training reads them. */
#include <string.h>

#include "fuzz_file.h"
#include "lab/render/sample.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    status (*const readers[])(const char *, sample *) = {sample_read, sample_read_training,
                                                         sample_read_training_environment};
    const char *path = fuzz_file(data, size);
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++) {
        sample s;
        if (readers[i](path, &s) == OK)
            sample_free(&s);
        else if (strchr(status_message(), '\n'))
            abort();
    }
    float sh[9][3];
    int version;
    (void)sample_read_sh(path, sh);
    (void)sample_read_version(path, &version);
    return 0;
}
